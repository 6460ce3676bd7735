.equ STEP, 0
        MOV     r0, #64 / STEP
        MOV     r1, #64 % (STEP * 2)
        HALT
