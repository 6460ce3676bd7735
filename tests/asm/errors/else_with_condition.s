.equ N, 2
.if N == 1
        ADD     r0, #1
.else N == 2
        ADD     r0, #2
.endif N
        HALT
