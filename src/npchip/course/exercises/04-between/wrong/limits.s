; the limits themselves are left out: HS and LS keep them
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
        WHERE   HI
          CMP   value, #192
          WHERE LO
            MOV out, #255
          END
        END
        OUT     0, out
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
