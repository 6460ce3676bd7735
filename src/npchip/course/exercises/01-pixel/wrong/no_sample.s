; the memory still holds 0: SAMPLE converts the pixels into it
.output corner, 0, plane
frame:  EXPOSE
        LD      r0, [0]
        OUT     0, r0
        JMP     frame
