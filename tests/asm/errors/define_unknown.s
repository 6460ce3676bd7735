; test: define TRESHOLD=16
.equ THRESHOLD, 32
        CMP     r0, #THRESHOLD
        HALT
