.equ LIMIT, 5
.ouput count, 0, scalar
.org 0
.byte 1, 2, 3
        MOV     r0, #LIMIT
        OUT     0, r0
        HALT
.end
