; top.s - Where does it begin?
.output top, 0, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg row, r3
.reg most, r4
.reg t, r5
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     pixel, #64
        ; your program
        JMP     frame
