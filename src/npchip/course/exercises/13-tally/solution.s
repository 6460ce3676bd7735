; solution.s - how many NPs have something dark
;
; A better one would walk with loops where words are short: the 32 words of the walks become 10, for
; two cycles more a step. And where only the program must know the number, the wire can tell: see
; `maximum`.
;
; The hidden checks:
; expect: words <= 60
; expect: cycles <= 860 points=2
; run: mouse frames=mouse_run
; expect: golden outputs points=3
; run: coin frames=coin_slide
; expect: golden outputs

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
