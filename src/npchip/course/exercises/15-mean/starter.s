; mean.s - A mean of many
.output mean, 0, plane
.reg pixel, r0
.reg value, r1
.reg low, r2
.reg high, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     low, #0
        MOV     high, #0
        MOV     pixel, #0
        ; your program
        JMP     frame
