; nothing is left: signal minus reset, each of them in a bank of its own
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg dark, r2
frame:  EXPOSE
        SAMPLE  reset, 0
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        LD      dark, [pixel]
        SUB     value, dark
        WHERE   LO
          MOV   value, #0
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
