; Schwelle für die Differenz
        MOV     r0, #32
        HALT
