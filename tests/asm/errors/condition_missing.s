loop:   CMP     r0, #5
        JANY    loop
        JMP     LO, loop
        HALT
