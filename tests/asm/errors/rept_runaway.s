        .rept   30000
        .rept   30000
        ADD     r0, #1
        .endr
        .endr
        HALT
