        r0 = 5
        [r1], r2
        5
        HALT
