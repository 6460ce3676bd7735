        MOV     r0, #'€'
        MOV     r0, #'\q'
        HALT
