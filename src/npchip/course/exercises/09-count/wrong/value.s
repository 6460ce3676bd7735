; that is the last pixel: after the loop send the counter
.output dark, 0, plane
.reg pixel, r0
.reg value, r1
.reg dark, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     dark, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          ADD   dark, #1
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        OUT     0, value
        JMP     frame
