        absdiff r0, r1
        HALT

.macro absdiff, a, b
        SUB     a, b
.endm
