.equ LIMIT, 5
.reg count, r0
.equ LIMIT, 6
.reg count, r1
count:  MOV     count, #LIMIT
        HALT
