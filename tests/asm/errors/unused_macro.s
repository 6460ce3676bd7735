.macro half, a
        SHR     a, #1
.endm
.macro third, a
        quarter a
.endm
.macro quarter, a
        SHR     a, #2
.endm
        HALT
