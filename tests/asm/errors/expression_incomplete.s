.equ A, 3 +
.equ B, (1 + 2
.equ C, 1 + 2)
.equ D, 3 4
.equ E, * 2
        MOV     r0, #A + B + C + D + E
        HALT
