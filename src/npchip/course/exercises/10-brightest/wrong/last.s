; in NP (2, 4) that is the darkest pixel, or the last: which one does your mask keep?
.output most, 0, plane
.reg pixel, r0
.reg value, r1
.reg most, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     most, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        MOV     most, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        OUT     0, most
        JMP     frame
