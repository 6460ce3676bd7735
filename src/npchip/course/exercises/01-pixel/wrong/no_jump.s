; the program runs past its last word: JMP frame waits for the next picture
.output corner, 0, plane
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        OUT     0, r0
