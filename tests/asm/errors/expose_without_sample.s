; the pixels are read from a memory that nothing has filled
.output first, 0, plane
frame:  EXPOSE
        LD      r0, [0]
        OUT     0, r0
        JMP     frame
