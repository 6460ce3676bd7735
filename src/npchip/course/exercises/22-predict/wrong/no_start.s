; now is missing from the sum: next begins as now, by MOV next, now, before now is added to it
.output next, 0, plane
.reg now, r0
.reg before, r1
.reg next, r2
.reg high, r3
.reg seen, r4
        MOV     seen, #0
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      now, [0]
        CMP     seen, #0
        WHERE   EQ
          MOV   before, now
        END
        MOV     high, #0
        ADD     next, now
        ADC     high, #0
        SUB     next, before
        SBC     high, #0
        CMP     high, #0
        WHERE   NE
          MOV   next, #255
          CMP   high, #1
          WHERE NE
            MOV next, #0
          END
        END
        OUT     0, next
        MOV     before, now
        MOV     seen, #1
        JMP     frame
