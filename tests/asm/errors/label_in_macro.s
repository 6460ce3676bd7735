.macro wait, reg
.again: SUB     reg, #1
        JANY    NE, .again
.endm
        MOV     r0, #10
        wait    r0
        JMP     .again
