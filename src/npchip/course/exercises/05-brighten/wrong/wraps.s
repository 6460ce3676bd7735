; 8 bits are full: 196 + 60 is 256, which wraps to 0; C tells where
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        ADD     value, #60
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
