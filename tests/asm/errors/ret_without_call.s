        MOV     r0, #5
        CALL    half
half:   SHR     r0, #1
        RET
