; solution.s - a picture without the offsets of its pixels
;
; A better one would not send negative noise as 0, which makes the dark a little too bright on
; average: it would add a pedestal first, as cameras do. Of its cycles 512 are the two conversions.
;
; expect: words <= 20
; expect: cycles <= 1700 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: grey levels=100,0 machine=uneven.yaml
; expect: picture == 100, 0 points=3
; mistake: max(picture[0]) > 156 ; that is more than light and offset together: send signal minus reset
; mistake: max(picture[0]) > 100 ; the fixed pattern is still in the picture: subtract what SAMPLE reset gives
; mistake: picture[0] == 156 ; reset minus signal is negative: subtract the other way round
; mistake: picture[0] == 0 ; nothing is left: signal minus reset, each of them in a bank of its own
; run: dark levels=0 machine=noisy.yaml
; expect: max(picture[0]) <= 30 points=2
; mistake: max(picture[0]) >= 200 ; noise below zero wraps round to white: where C is set, send 0
; run: drawn frames=coin_slide first=1 machine=uneven.yaml
; expect: sum(picture[0]) == 848727 points=2
; run: city frames=city_night first=2 machine=uneven.yaml
; expect: golden outputs points=3
; run: coin frames=coin_slide first=2 machine=noisy.yaml
;; the noise depends on the order of the two conversions: a sum of 5,120 pixels is right within 2,000
; expect: sum(picture[0]) >= 846727
; expect: sum(picture[0]) <= 850727
; expect: max(picture) <= 200
; run: night levels=0,1,2 machine=noisy.yaml
; expect: sum(picture[0]) >= 7200
; expect: sum(picture[0]) <= 9700
; expect: max(picture) <= 32

.output picture, 0, picture
.reg pixel, r0
.reg value, r1
.reg dark, r2
frame:  EXPOSE
        SAMPLE  reset, 64
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        LD      dark, [pixel + 64]
        SUB     value, dark
        WHERE   LO
          MOV   value, #0
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
