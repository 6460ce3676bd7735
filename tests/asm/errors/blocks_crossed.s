.equ N, 1
.macro twice, a
.if N
        ADD     a, a
.endm
.rept 2
        twice   r0
.endif
.endr
        HALT
