; solution.s - how far every pixel lies from 100
;
; A better one would turn a number round without a mask: after SUB, `SBC t, t` is -1 or 0, and
; (value ^ t) - t does either. But there is no XOR, so that only the loop can be shortened, with
; `.rept 8` around its body.
;
; expect: words <= 18
; expect: cycles <= 1450 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: steps levels=0,80,99,100,101,120,255
; expect: distance == 100, 20, 1, 0, 1, 20, 155 points=3
; mistake: distance == 0, 80, 99, 100, 101, 120, 255 ; the pixels are sent as they are: subtract 100 first, or OUT sends another register than the one with the distance
; mistake: distance == 156, 236, 255, 0, 1, 20, 155 ; pixels below 100 wrap round: where C is set, turn the result round; if you do, is it in the register that OUT sends?
; mistake: distance == 0, 0, 0, 0, 1, 20, 155 ; what is darker counts as well: turn a negative result round
; mistake: distance == 99, 19, 0, 0, 1, 20, 155 ; 255 - x is one less than 0 - x
; mistake: distance[5] == 236 ; the wrong ones are turned round: WHERE LO keeps the pixels below 100, whose difference is negative
; run: drawn frames=shapes_drawn
; expect: sum(distance[0]) == 722484 points=2
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: mouse frames=mouse_run first=2
; expect: golden outputs

.output distance, 0, picture
.reg pixel, r0
.reg value, r1
.reg other, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        SUB     value, #100
        WHERE   LO
          MOV   other, value
          MOV   value, #0
          SUB   value, other
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
