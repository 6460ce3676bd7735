        MOV     r0, #[31m5
        HALT
