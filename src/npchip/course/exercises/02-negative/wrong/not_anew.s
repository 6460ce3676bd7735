; each pixel is subtracted from what the one before has left: 255 goes into the register anew for every pixel, inside the loop
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg light, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
        MOV     light, #255
.next:  LD      value, [pixel]
        SUB     light, value
        OUT     0, light
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
