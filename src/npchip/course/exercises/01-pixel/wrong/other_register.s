; that is another register than the one that LD loads the first pixel into
.output corner, 0, plane
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        OUT     0, r1
        JMP     frame
