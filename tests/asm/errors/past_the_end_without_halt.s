        EXPOSE
        SAMPLE  signal, 0
        OUT     0, r0
