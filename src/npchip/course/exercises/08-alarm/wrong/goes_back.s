; a frame full of light is looked at to its end: JANY leaves the loop at the first bright pixel, and nothing goes back
.output alarm, 0, scalar
.reg pixel, r0
.reg value, r1
.reg state, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     state, #0
        MOV     pixel, #0
again:  LD      value, [pixel]
        CMP     value, #200
        JANY    HI, found
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, again
        JMP     send
found:  MOV     state, #1
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, again
send:   OUT     0, state
        JMP     frame
