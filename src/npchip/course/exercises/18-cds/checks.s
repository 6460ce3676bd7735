; checks.s - what npchip learn check looks at
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
