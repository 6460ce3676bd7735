; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
.output alarm, 0, scalar
.reg pixel, r0
.reg value, r1
.reg state, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     state, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #200
        WHERE   HI
          JMP   found
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     send
found:  MOV     state, #1
send:   OUT     0, state
        JMP     frame
