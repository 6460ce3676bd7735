        CALL    half
        HALT
        MOV     r0, #0
        MOV     r1, #0
half:   SHR     r0, #1
        RET
never:  NOP
        JMP     never
