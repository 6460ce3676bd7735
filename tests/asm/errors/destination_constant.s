        MOV     #5, r0
        ST      r0, [5]
        OUT     r0, 1
        HALT
