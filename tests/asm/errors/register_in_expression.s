.reg pixel, r3
        MOV     r0, #pixel + 1
        MOV     r1, #(r2)
        HALT
