; the high byte belongs above the two bits that SHR low, #6 has left: SHL high, #2
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
        SHR     low, #6
        SHL     high, #6
        OR      low, high
        OUT     0, low
        JMP     frame
