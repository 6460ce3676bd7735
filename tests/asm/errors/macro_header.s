.macro
        ADD     r0, #1
.endm
.macro sum, 5
        ADD     r0, #1
.endm
.macro sum a b
        ADD     a, b
.endm
        HALT
