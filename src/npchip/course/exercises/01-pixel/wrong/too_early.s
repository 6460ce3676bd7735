; the byte is sent before it is loaded: OUT comes after LD
.output corner, 0, plane
frame:  EXPOSE
        SAMPLE  signal, 0
        OUT     0, r0
        LD      r0, [0]
        JMP     frame
