frame:  EXPOSE
        JANY    HI, found
        JMP     .send
found:  MOV     r0, #1
.send:  OUT     0, r0
        JMP     frame
other:  JMP     .again
again:  NOP
.again: JMP     frame
