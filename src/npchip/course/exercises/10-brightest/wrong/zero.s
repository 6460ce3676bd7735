; nothing ever replaces the 0: compare most with value, and keep the NPs in which it is lower
.output most, 0, plane
.reg pixel, r0
.reg value, r1
.reg most, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     most, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     most, value
        WHERE   HI
          MOV   most, value
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        OUT     0, most
        JMP     frame
