        MOV     r0, 5
        ADD     r0, -1
        SHL     r0, 2
        HALT
