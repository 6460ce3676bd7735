        MOV     r0, #5
        HALT
