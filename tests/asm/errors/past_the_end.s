        CMP     r0, #5
        JANY    LO, after
        MOV     r0, #5
        JNONE   EQ, after
after:
