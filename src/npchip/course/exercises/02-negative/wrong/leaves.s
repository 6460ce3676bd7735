; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg light, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        MOV     light, #255
        SUB     light, value
        OUT     0, light
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    HI, .next
        JMP     frame
