; the best of an earlier frame is kept: begin with 0 in every frame
.output most, 0, plane
.reg pixel, r0
.reg value, r1
.reg most, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     most, value
        WHERE   LO
          MOV   most, value
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        OUT     0, most
        JMP     frame
