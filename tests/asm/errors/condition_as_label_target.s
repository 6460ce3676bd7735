loop:   CMP     r0, #5
        JANY    loop, LO
        JMP     r0
        CALL    #loop
        HALT
