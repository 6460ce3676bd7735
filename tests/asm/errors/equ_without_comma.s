.equ LIMIT 5
.equ WIDTH
.reg pixel r0
.equ 5, LIMIT
        CMP     pixel, #LIMIT
        CMP     pixel, #WIDTH
        HALT
