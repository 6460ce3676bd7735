loop:   ADD     r0, #1
        JMP     loop
loop:   ADD     r1, #1
        JMP     loop
