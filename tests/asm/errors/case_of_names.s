.equ Threshold, 32
        CMP     r0, #THRESHOLD
        HALT
