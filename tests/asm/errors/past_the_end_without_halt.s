        EXPOSE
        SAMPLE  signal, 0
        LD      r0, [5]
        OUT     0, r0
