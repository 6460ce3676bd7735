; pasted from a PDF
.equ LIMIT, 10
        SUB     r0, #LIMIT – 1
        HALT
