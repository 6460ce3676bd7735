; shift.s - Halos: pixels of the neighbour
.output shifted, 0, picture
.reg pixel, r0
.reg value, r1
.reg left, r2
.reg t, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
        ; your program
        JMP     frame
