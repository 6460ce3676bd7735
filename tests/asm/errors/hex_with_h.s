        MOV     r0, #0FFh
        AND     r0, #7fh
        HALT
