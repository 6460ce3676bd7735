        MOV     r16, #0
        ADD     r0, r20
        HALT
