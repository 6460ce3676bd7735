; that is the sum divided by 256: six bits to the right, not eight
.output mean, 0, plane
.reg pixel, r0
.reg value, r1
.reg low, r2
.reg high, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     low, #0
        MOV     high, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        ADD     low, value
        ADC     high, #0
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        OUT     0, high
        JMP     frame
