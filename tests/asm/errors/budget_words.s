.budget words 3
        MOV     r0, #0
loop:   ADD     r0, #1
        CMP     r0, #64
        JANY    LO, loop
        HALT
