.equ LIMIT, 64
.equ LIMITS, 65
.reg count, r0
.reg counter, r1
.if 0
        CMP     counter, #1
.endif
        MOV     r0, #LIMIT
        HALT
