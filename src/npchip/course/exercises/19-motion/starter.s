; motion.s - What has changed
.output moving, 0, picture
.equ NOW, 0
.equ BEFORE, 64
.reg pixel, r0
.reg value, r1
.reg before, r2
.reg t, r3
.reg seen, r4
        MOV     seen, #0
frame:  EXPOSE
        SAMPLE  signal, NOW
        MOV     pixel, #0
.next:  LD      value, [pixel + NOW]
        ; your program
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
