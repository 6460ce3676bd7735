; 8 bits are not enough for the sum: ADC high, #0 goes on, directly behind ADD low, value
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
        ADD     pixel, #1
        ADC     high, #0
        CMP     pixel, #64
        JANY    LO, .next
        SHR     low, #6
        SHL     high, #2
        OR      low, high
        OUT     0, low
        JMP     frame
