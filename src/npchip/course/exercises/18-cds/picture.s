; picture.s - the solution, which also sends what the uneven sensor gives, for the picture of the page
.output uneven, 1, picture
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg dark, r2
frame:  EXPOSE
        SAMPLE  reset, 64
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        OUT     1, value
        LD      dark, [pixel + 64]
        SUB     value, dark
        WHERE   LO
          MOV   value, #0
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
