; one of two conditions is enough here: put one WHERE inside the other
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
        CMP     value, #192
        WHERE   LS
          MOV   out, #255
        END
        OUT     0, out
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
