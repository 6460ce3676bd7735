; total.s - Sixteen bits
.output dark, 0, scalar16
.reg pixel, r0
.reg value, r1
.reg low, r2
.reg high, r3
.reg t, r4
.reg th, r5
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     low, #0
        MOV     high, #0
        MOV     pixel, #0
        ; your program
        JMP     frame
