.macro half, a
        SHR     a, #1

frame:  EXPOSE
        half    r0
        JMP     frame
