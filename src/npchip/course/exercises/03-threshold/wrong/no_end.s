; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
.output bright, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #128
        MOV     value, #0
        WHERE   HI
          MOV   value, #255
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
