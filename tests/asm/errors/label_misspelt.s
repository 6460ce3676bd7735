loop:   ADD     r0, #1
        CMP     r0, #64
        JANY    LO, lopp
        HALT
