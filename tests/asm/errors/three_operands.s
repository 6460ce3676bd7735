        ADD     r0, r1, r2
        SUB     r0, r1, #1
        RET     r0
        HALT    0
