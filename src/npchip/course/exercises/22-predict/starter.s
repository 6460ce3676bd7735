; predict.s - One frame ahead
.output next, 0, plane
.reg now, r0
.reg before, r1
.reg next, r2
.reg high, r3
.reg seen, r4
        MOV     seen, #0
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      now, [0]
        ; your program
        OUT     0, now
        JMP     frame
