; nothing is sent where no pixel is brighter: the end of the loop leads to OUT as well
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
found:  MOV     state, #1
        OUT     0, state
send:   JMP     frame
