# counts the pixels
loop:   ADD     r0, #1
        JMP     loop
