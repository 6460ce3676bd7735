; the frames of the clip are never taken
.output first, 0, plane
        SAMPLE  signal, 0
        LD      r0, [0]
        OUT     0, r0
        HALT
