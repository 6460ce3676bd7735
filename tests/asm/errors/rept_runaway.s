        .rept   9000
        .rept   9000
        ADD     r0, #1
        .endr
        .endr
        HALT
