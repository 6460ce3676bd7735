; keypoint.s - A key point
.output row, 0, scalar
.output col, 1, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg row, r3
.reg most, r4
.reg t, r5
.reg top, r6
.reg col, r7
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     pixel, #64
        ; your program
        JMP     frame
