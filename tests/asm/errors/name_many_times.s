        CMP     r0, #THRESHOLD
        CMP     r1, #THRESHOLD
        CMP     r2, #THRESHOLD
        CMP     r3, #Treshold
        HALT
