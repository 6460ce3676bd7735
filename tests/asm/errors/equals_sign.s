LIMIT = 40
.equ WIDTH = 8
        CMP     r0, #LIMIT
        CMP     r1, #WIDTH
        HALT
