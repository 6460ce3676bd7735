        NBR     r0, r1, up
        NBR     r0, r1, nroth
        NBR     r0, north, r1
        HALT
