        ADD     r0, #1
.endr
.endm
.else
        ADD     r0, #2
.endif
        HALT
