; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg light, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        MOV     light, #255
        SUB     light, value
        OUT     0, light
        ADD     pixel, #1
        JMP     .next
