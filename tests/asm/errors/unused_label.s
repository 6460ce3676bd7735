        MOV     r0, #0
start:  ADD     r0, #1
loop:   ADD     r0, #2
.here:  CMP     r0, #64
        JANY    LO, start
        HALT
