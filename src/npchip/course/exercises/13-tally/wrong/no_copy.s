; the second walk carries what the first one has left in t: MOV t, sum goes before it
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
        .rept NP_ROWS - 1
          NBR   t, t, north
          ADD   sum, t
        .endr
        ROW     t
        CMP     t, #NP_ROWS - 1
        WHERE   EQ
          COL   t
          CMP   t, #NP_COLS - 1
          WHERE EQ
            OUT 0, sum
          END
        END
        JMP     frame
