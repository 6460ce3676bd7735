; the pattern is right, but white is 255, not 1
.output board, 0, plane
        ROW     r0
        COL     r1
        ADD     r0, r1
        AND     r0, #1
        OUT     0, r0
        HALT
