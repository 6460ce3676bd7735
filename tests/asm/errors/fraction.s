        MOV     r0, #1.5
        HALT
