; alarm.s - One wire: the global OR
.output alarm, 0, scalar
.reg pixel, r0
.reg value, r1
.reg state, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     state, #0
        MOV     pixel, #0
        ; your program
        JMP     frame
