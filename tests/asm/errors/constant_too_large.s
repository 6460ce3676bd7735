        MOV     r0, #256
        ADD     r0, #-129
        AND     r0, #0x1FF
        HALT
