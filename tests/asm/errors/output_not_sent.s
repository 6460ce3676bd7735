.output row, 0, scalar
.output col, 1, scalar
        OUT     0, r0
        HALT
        OUT     1, r0   ; npchip: allow NPW04 for the debugger
