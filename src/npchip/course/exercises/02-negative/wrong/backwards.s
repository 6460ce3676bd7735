; you compute value - 255: the 255 belongs into the destination of SUB
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg light, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        SUB     value, #255
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
