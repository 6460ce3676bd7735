; solution.s - what has changed by 32 or more
;
; A better one would take the first frame out of the loop: a copy of the frame before the loop, made
; once, saves four cycles a pixel in every frame. And |a - b| >= T needs no mask: docs/programming.md
; of npchip has a carry chain that says it in six instructions.
;
; expect: words <= 36
; expect: cycles <= 2500 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: steps levels=100,100,132,131,90,121
; expect: moving == 0, 0, 255, 0, 255, 0 points=3
; mistake: moving == 100, 100, 132, 131, 90, 121 ; the pixels are sent as they are: compare them with the frame before
; mistake: moving == 255, 0, 255, 0, 255, 0 ; in the first frame nothing moves: it must not be compared with an empty memory
; mistake: moving == 0, 255, 255, 255, 255, 255 ; it is compared with an empty memory: store every pixel for the next frame
; mistake: moving == 0 ; nothing ever moves: seen becomes 1 at the end of every frame
; mistake: moving == 0, 0, 255, 0, 0, 0 ; what becomes darker moves as well: take the absolute value
; mistake: moving == 0, 0, 0, 0, 255, 0 ; a difference of 32 is enough: HS, not HI
; mistake: moving == 0, 0, 255, 255, 255, 255 ; negative differences wrap round: take the absolute value
; run: coin frames=coin_slide first=10
; expect: sum(moving[6]) == 34170 points=2
; expect: sum(moving[0]) == 0
; run: mouse frames=mouse_run first=4
; expect: golden outputs points=3
; run: ball frames=ball_fall_30000fps first=4
; expect: golden outputs

.output moving, 0, picture
.equ NOW, 0
.equ BEFORE, 64
.reg pixel, r0
.reg value, r1
.reg before, r2
.reg t, r3
.reg seen, r4
        MOV     seen, #0
frame:  EXPOSE
        SAMPLE  signal, NOW
        MOV     pixel, #0
.next:  LD      value, [pixel + NOW]
        LD      before, [pixel + BEFORE]
        ST      [pixel + BEFORE], value
        CMP     seen, #0
        WHERE   EQ
          MOV   before, value
        END
        SUB     value, before
        WHERE   LO
          MOV   t, value
          MOV   value, #0
          SUB   value, t
        END
        CMP     value, #32
        MOV     value, #0
        WHERE   HS
          MOV   value, #255
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     seen, #1
        JMP     frame
