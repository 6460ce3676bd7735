.if WIDE
        MOV     r0, #16
.endif
        .rept   COUNT
        ADD     r0, #1
        .endr
.equ WIDE, COUNT > 8
.equ COUNT, 10
        HALT
