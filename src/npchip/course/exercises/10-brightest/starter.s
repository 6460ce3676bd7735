; brightest.s - The largest of 64
.output most, 0, plane
.reg pixel, r0
.reg value, r1
.reg most, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
        ; your program
        JMP     frame
