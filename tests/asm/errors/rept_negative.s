.equ N, 3
        .rept N - 5
        ADD     r0, #1
        .endr
        HALT
