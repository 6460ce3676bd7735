; that is row + column: AND #1 keeps the lowest bit alone
.output board, 0, plane
        ROW     r0
        COL     r1
        ADD     r0, r1
        OUT     0, r0
        HALT
