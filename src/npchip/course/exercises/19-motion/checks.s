; checks.s - what npchip learn check looks at
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
