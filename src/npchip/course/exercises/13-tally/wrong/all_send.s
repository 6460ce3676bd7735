; only the NP at the lower right has the sum: the others must be switched off when it is sent
.output nps, 0, scalar
.reg pixel, r0
.reg value, r1
.reg t, r2
.reg sum, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     t, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   t, #1
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     sum, t
        .rept NP_COLS - 1
          NBR   t, t, west
          ADD   sum, t
        .endr
        MOV     t, sum
        .rept NP_ROWS - 1
          NBR   t, t, north
          ADD   sum, t
        .endr
        OUT     0, sum
        JMP     frame
