; the wrong ones are turned round: WHERE LO keeps the pixels below 100, whose difference is negative
.output distance, 0, picture
.reg pixel, r0
.reg value, r1
.reg other, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        SUB     value, #100
        WHERE   HI
          MOV   other, value
          MOV   value, #0
          SUB   value, other
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
