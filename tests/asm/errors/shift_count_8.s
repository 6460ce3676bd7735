        SHL     r0, #8
        SHR     r0, #0
        HALT
