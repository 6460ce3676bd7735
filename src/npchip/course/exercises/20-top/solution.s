; solution.s - the first row with something dark
;
; A better one would look at rows, not at pixels: eight comparisons of the smallest of eight pixels
; with 100 instead of 64. And it would stop at the first NP row that has any, by JANY.
;
; expect: words <= 90
; expect: cycles <= 920 points=2
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: top == null ; nothing is sent yet: find the first dark pixel of every NP, then the smallest row
; run: flat levels=255,50
; expect: top == 255, 0 points=2
; mistake: top[0] == 0 ; NPs without a dark pixel have no row: their candidate is 255
; mistake: top[0] == 8 ; a white picture has a dark pixel: the byte at 64 is none of the picture, so subtract 1 from pixel before LD
; mistake: top[1] == 63 ; that is the last row with a dark pixel: look for the first
; mistake: top[1] == 7 ; that is the last row of an NP: go through its pixels backwards
; mistake: top[1] == 56 ; that is the largest candidate: of 255 - x the largest is the smallest x
; run: drawn frames=shapes_drawn
; expect: top == 8, 11, 6, 5 points=3
; mistake: top[0] == 0 ; a row within its NP: add 8 times the number of the NP's row
; mistake: top[0] == 7 ; a row within its NP: add 8 times the number of the NP's row
; run: mouse frames=mouse_run
; expect: golden outputs points=3
; run: coin frames=coin_slide
; expect: golden outputs

.output top, 0, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg row, r3
.reg most, r4
.reg t, r5
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     pixel, #64
.next:  SUB     pixel, #1
        LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   first, pixel
        END
        CMP     pixel, #0
        JANY    NE, .next
        MOV     row, #255
        CMP     first, #255
        WHERE   NE
          ROW   row
          SHL   row, #3
          MOV   t, first
          SHR   t, #3
          ADD   row, t
        END
        MOV     value, #255
        SUB     value, row
        MOV     most, #0
        .rept 8, bit
          SHL   value, #1
          JNONE CS, .clear
          SBC   t, t
          AND   value, t
          OR    most, #0x80 >> bit
.clear:
        .endr
        MOV     value, #255
        SUB     value, most
        OUT     0, value
        JMP     frame
