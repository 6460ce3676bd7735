; solution.s - how many NPs have something dark
;
; A better one would walk with loops where words are short: the 32 words of the walks become 10, for
; two cycles more a step. And where only the program must know the number, the wire can tell: see
; `maximum`.
;
; expect: words <= 60
; expect: cycles <= 860 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: error == NP310 ; only the NP at the lower right has the sum: the others must be switched off when it is sent
; mistake: nps == null ; nothing is sent yet: OUT 0, sum in the last NP
; run: steps levels=100,99,100
; expect: nps == 0, 80, 0 points=2
; mistake: nps[1] == 176 ; 255 a dark NP: sums of them wrap, so let t be 1
; mistake: nps[1] == 99 ; one step too many: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[1] == 72 ; one step too few: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[1] == 70 ; one step too few: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[1] == 8 ; that is the sum of the last column: the rows must be added up first
; mistake: nps[1] == 10 ; that is the sum of the last row: copy sum to t, then walk from the north
; mistake: nps[1] == 17 ; the second walk carries what the first one has left in t: MOV t, sum goes before it
; mistake: nps[0] != 0 ; a pixel of 100 is not darker than 100: LO, not LS
; mistake: nps[2] != 0 ; what an earlier frame had is kept: begin with 0 in every frame
; run: drawn frames=shapes_drawn
; expect: nps[0] == 30 points=2
; expect: nps[3] == 40
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
