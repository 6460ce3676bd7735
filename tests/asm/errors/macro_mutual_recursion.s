.macro ping
        ADD     r0, #1
        pong
.endm
.macro pong
        SUB     r0, #1
        ping
.endm
start:  ping
        JMP     start
