        LD      r0, [#5]
        OUT     #0, r0
        MOV     r1, ##5
        SAMPLE  signal, #64
        HALT
