; a library for the tests of .include
.equ LIMIT, 40
.macro half, a
        SHR     a, #1
.endm
