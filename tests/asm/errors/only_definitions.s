.equ LIMIT, 5
.macro half, a
        SHR     a, #1
.endm
