; NBR gives the same pixel of the western NP: only the first pixel of a row needs it, for the others keep the pixel before
.output shifted, 0, picture
.reg pixel, r0
.reg value, r1
.reg left, r2
.reg t, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.row:   ADD     pixel, #7
        LD      value, [pixel]
        NBR     left, value, west
        SUB     pixel, #7
.next:  LD      value, [pixel]
        NBR     left, value, west
        OUT     0, left
        MOV     left, value
        ADD     pixel, #1
        MOV     t, pixel
        AND     t, #7
        JANY    NE, .next
        CMP     pixel, #64
        JANY    LO, .row
        JMP     frame
