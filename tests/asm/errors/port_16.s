.output count, 16, scalar
        OUT     16, r0
        IN      r0, -1
        HALT
