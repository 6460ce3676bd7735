; in NP (3, 6) that is the last pixel: keep the best so far where it is not lower
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
