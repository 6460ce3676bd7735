.macro half, a
        SHR     a, #1
.endm
.macro half, b
        SHR     b, #1
.endm
.macro add, a
        ADD     a, #1
.endm
.macro sum, a, a
        ADD     a, a
.endm
        half    r0
        HALT
