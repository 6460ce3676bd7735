; the condition is the wrong way round: C is set where the sum did not fit
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        ADD     value, #60
        WHERE   CC
          MOV   value, #255
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
