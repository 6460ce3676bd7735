; nothing ever moves: seen becomes 1 at the end of every frame
.output moving, 0, picture
.equ NOW, 0
.equ BEFORE, 64
.reg pixel, r0
.reg value, r1
.reg before, r2
.reg t, r3
.reg seen, r4
        MOV     seen, #0
frame:  EXPOSE
        SAMPLE  signal, NOW
        MOV     pixel, #0
.next:  LD      value, [pixel + NOW]
        LD      before, [pixel + BEFORE]
        ST      [pixel + BEFORE], value
        CMP     seen, #0
        WHERE   EQ
          MOV   before, value
        END
        SUB     value, before
        WHERE   LO
          MOV   t, value
          MOV   value, #0
          SUB   value, t
        END
        CMP     value, #32
        MOV     value, #0
        WHERE   HS
          MOV   value, #255
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
