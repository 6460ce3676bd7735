frame:  EXPOSE
        SAMPEL  signal, 0
        HLAT
        JMP     frame
