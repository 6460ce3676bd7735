        MOV     r0, #‘A’
        .error  “too large”
        HALT
