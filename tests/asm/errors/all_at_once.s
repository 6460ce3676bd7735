; nine mistakes, each told once, nothing told that only follows from another
.equ LIMIT, 10 *
.reg  value, 3
.macro clamp, x
        CMP     x, #LIMIT
        WHERE   HI
          MOV   x, LIMIT
        END
.endm
start:  MOVE    value, #5
        clamp   value
        clamp   r1
        clamp   r2, r3
wrong:  SHL     value, #9
        CMP     r1, #LIMIT
        JANY    EQUAL, start
        JMP     wrong
        OUT     0 value
        JMP     strat
        WHERE   LO
        JMP     start
