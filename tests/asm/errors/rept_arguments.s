        .rept
        ADD     r0, #1
        .endr
        .rept   3, 4
        ADD     r0, #1
        .endr
        .rept   3 i
        ADD     r0, #1
        .endr
        HALT
