.macro clamp, value, limit
        CMP     value, #limmit
        WHERE   HI
          MOV   value, #limit
        END
.endm
        clamp   r0, 63
        clamp   r1, 79
        HALT
