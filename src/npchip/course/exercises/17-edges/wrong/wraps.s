; negative differences wrap round: take the absolute value
.output edges, 0, picture
.reg pixel, r0
.reg value, r1
.reg left, r2
.reg t, r3
.macro absdiff a, b, t
        MOV     t, b
        SUB     t, a
        SUB     a, b
.endm
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.row:   ADD     pixel, #7
        LD      value, [pixel]
        NBR     left, value, west
        SUB     pixel, #7
.next:  LD      value, [pixel]
        absdiff left, value, t
        OUT     0, left
        MOV     left, value
        ADD     pixel, #1
        MOV     t, pixel
        AND     t, #7
        JANY    NE, .next
        CMP     pixel, #64
        JANY    LO, .row
        JMP     frame
