        .rept   3
wait:   SUB     r0, #1
        JANY    NE, wait
        .endr
        HALT
