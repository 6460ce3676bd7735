.equ LIMIT, 40 +
.macro half, a
        SHR     a, 1
.endm
        SHL     r0, 1
