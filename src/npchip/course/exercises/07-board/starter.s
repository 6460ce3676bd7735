; board.s - Where am I?
.output board, 0, plane
        ROW     r0
        OUT     0, r0
        HALT
