; cds.s - Sampling twice
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg dark, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        ; your program
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
