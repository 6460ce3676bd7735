.macro SUB, a, b
        ADD     a, b
.endm
.macro end
        HALT
.endm
        SUB     r0, r1
        end
