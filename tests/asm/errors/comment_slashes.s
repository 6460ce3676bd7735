loop:   ADD     r0, #1          // next pixel
        JMP     loop
