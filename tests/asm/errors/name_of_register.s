.equ r1, 5
.reg R2, r3
r15:    ADD     r1, #1
.equ ROWS, 64
NP_COLS: HALT
