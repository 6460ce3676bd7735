; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
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
        JANY    HI, found
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     send
found:  WHERE   HI
          MOV   state, #1
        END
send:   OUT     0, state
        JMP     frame
