; the bytes are exchanged: the low one is sent first
.output dark, 0, scalar16
.reg pixel, r0
.reg value, r1
.reg low, r2
.reg high, r3
.reg t, r4
.reg th, r5
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     low, #0
        MOV     high, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          ADD   low, #1
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     t, low
        .rept NP_COLS - 1
          NBR   t, t, west
          ADD   low, t
          ADC   high, #0
        .endr
        MOV     t, low
        MOV     th, high
        .rept NP_ROWS - 1
          NBR   t, t, north
          NBR   th, th, north
          ADD   low, t
          ADC   high, th
        .endr
        ROW     t
        CMP     t, #NP_ROWS - 1
        WHERE   EQ
          COL   t
          CMP   t, #NP_COLS - 1
          WHERE EQ
            OUT 0, high
            OUT 0, low
          END
        END
        JMP     frame
