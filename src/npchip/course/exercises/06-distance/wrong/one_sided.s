; what is darker counts as well: turn a negative result round
.output distance, 0, picture
.reg pixel, r0
.reg value, r1
.reg other, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        SUB     value, #100
        WHERE   LO
          MOV   value, #0
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
