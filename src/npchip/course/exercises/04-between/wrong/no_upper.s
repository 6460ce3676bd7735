; the upper limit has no effect: is its WHERE inside the first?
.output middle, 0, picture
.reg pixel, r0
.reg value, r1
.reg out, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        MOV     out, #0
        CMP     value, #64
        WHERE   HS
          MOV   out, #255
        END
        OUT     0, out
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
