; count.s - Counting in every NP
.output dark, 0, plane
.reg pixel, r0
.reg value, r1
.reg dark, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
        ; your program
        JMP     frame
