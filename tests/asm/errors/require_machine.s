.equ MOST, 4
.require NP_ROWS <= MOST, "the sum of two row numbers has 8 bits"
        MOV     r0, #NP_ROWS * 64 - 1
        HALT
