; pixels below 100 wrap round: where C is set, turn the result round; if you do, is it in the register that OUT sends?
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
          MOV   other, #0
          SUB   other, value
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
