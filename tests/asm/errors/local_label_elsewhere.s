first:  MOV     r0, #0
.loop:  ADD     r0, #1
        CMP     r0, #5
        JANY    LO, .loop
second: MOV     r1, #0
        JMP     .loop
