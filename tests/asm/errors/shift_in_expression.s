.equ N, 64
        MOV     r0, #1 << N
        MOV     r1, #1 >> -1
        MOV     r2, #9999999999 * 9999999999
        HALT
