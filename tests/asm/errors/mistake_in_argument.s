.macro clamp, value, limit
        CMP     value, #limit
        WHERE   HI
          MOV   value, #limit
        END
.endm
        clamp   r0, 300
        clamp   r1, LIMT
        clamp   5, 63
        HALT
