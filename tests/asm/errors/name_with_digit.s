2nd:    ADD     r0, #1
        HALT
