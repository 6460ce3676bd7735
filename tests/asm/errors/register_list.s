        MOV     {r0, r1}, #0
        HALT
