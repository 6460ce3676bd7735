.macro down, n
        SUB     r0, #n
        down    n - 1
.endm
        down    5
        HALT
