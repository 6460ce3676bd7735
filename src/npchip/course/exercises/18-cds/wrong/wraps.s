; noise below zero wraps round to white: where C is set, send 0
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg dark, r2
frame:  EXPOSE
        SAMPLE  reset, 64
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        LD      dark, [pixel + 64]
        SUB     value, dark
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
