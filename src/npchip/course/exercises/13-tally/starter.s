; tally.s - Sums across the array
.output nps, 0, scalar
.reg pixel, r0
.reg value, r1
.reg t, r2
.reg sum, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     t, #0
        MOV     pixel, #0
        ; your program
        JMP     frame
