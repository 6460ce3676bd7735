        MOV     r0, #0
loop    ADD     r0, #1
again
        CMP     r0, #64
        JANY    LO, loop
        JANY    HI, again
        HALT
