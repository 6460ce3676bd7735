; the program runs into found also where the loop has ended: jump over it
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
found:  MOV     state, #1
send:   OUT     0, state
        JMP     frame
