        MOV     r0, #0
        .loop   0
next:   ADD     r0, #1
        .loop   9, 8
        CMP     r0, #8
        .loop
        JANY    LO, next
        .loop   1, 2
        .loop   2
        HALT
