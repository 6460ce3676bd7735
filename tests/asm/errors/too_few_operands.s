        ADD     r0
        SHL     r0
        NBR     r0, r1
        JMP
        WHERE
        LD      r0,
        HALT
