; centre.s - The centre
.output center_row, 0, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg last, r3
.reg top, r4
.reg most, r5
.reg t, r6
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     last, #0
        MOV     pixel, #0
        ; your program
        JMP     frame
