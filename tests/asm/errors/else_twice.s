.equ N, 1
.if N == 1
        ADD     r0, #1
.else
        ADD     r0, #2
.else
        ADD     r0, #3
.elif N == 5
.endif
        HALT
