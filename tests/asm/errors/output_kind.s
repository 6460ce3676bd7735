.output valid, 0, scaler
.output center, 1, byte
.output picture, 2
        OUT     0, r0
        HALT
