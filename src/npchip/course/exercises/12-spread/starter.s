; spread.s - Neighbours
.output near, 0, plane
.reg pixel, r0
.reg value, r1
.reg mine, r2
.reg near, r3
.reg t, r4
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     near, #0
        MOV     mine, #0
        MOV     pixel, #0
        ; your program
        JMP     frame
