.equ WIDE, 1
.if WIDE
        MOV     r0, #16
.else
        MOV     r0, #8
frame:  EXPOSE
        JMP     frame
