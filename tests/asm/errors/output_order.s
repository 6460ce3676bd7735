.output 0, count, scalar
.output count, scalar, 0
        OUT     0, r0
        HALT
