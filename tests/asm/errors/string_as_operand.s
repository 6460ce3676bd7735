        MOV     r0, #"A"
        HALT
