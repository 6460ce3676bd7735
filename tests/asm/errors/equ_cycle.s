.equ WIDTH, HEIGHT * 2
.equ HEIGHT, WIDTH / 2
.equ SELF, SELF + 1
        MOV     r0, #WIDTH
        MOV     r1, #HEIGHT
        MOV     r2, #SELF
        HALT
