.macro clamp, value, limit
        CMP     value, #limit
        WHERE   HI
          MOV   value, #limit
        END
.endm
.macro stop
        HALT
.endm
        clamp   r0
        clamp   r0, 63, r1
        clamp   r0,
        clamp
        clamp   r0 63
        stop    r0
