loop:   LDR     r1, [r0]
        EOR     r1, r2
        LSL     r1, #2
        ORR     r1, r3
        BNE     loop
        BL      loop
        B       loop
