; left is what the row above has left behind: each row begins with NBR from the west
.output shifted, 0, picture
.reg pixel, r0
.reg value, r1
.reg left, r2
.reg t, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.row:
.next:  LD      value, [pixel]
        OUT     0, left
        MOV     left, value
        ADD     pixel, #1
        MOV     t, pixel
        AND     t, #7
        JANY    NE, .next
        CMP     pixel, #64
        JANY    LO, .row
        JMP     frame
