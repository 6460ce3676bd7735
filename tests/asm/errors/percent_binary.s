        MOV     r0, #%1010
        MOV     r1, #&FF
        MOV     r2, #2 ** 3
        HALT
