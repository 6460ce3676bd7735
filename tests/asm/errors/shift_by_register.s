        SHL     r0, r1
        HALT
