; negative.s - All 64 pixels
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
        LD      value, [pixel]
        OUT     0, value
        ; more than one pixel?
        JMP     frame
