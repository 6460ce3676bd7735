        .rept   600
        NOP
        .endr
        HALT
