.reg value, r0
.equ LIMIT, 5
frame:  MOV     far, value
        LD      value, [far]
        OUT     0, far
        ADD     valeu, far
        LD      r2, [other]
        MOV     LIMIT, value
        MOV     frame, value
        JMP     nowhere
