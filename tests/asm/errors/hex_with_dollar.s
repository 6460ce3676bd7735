        MOV     r0, #$FF
        HALT
