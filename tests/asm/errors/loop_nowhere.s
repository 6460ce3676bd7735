        .loop   8
        MOV     r0, #0
next:   ADD     r0, #1
        OUT     0, r0
        CMP     r0, #8
        JANY    LO, next
        HALT
