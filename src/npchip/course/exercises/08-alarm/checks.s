; checks.s - what npchip learn check looks at
;
; expect: words <= 16
; expect: cycles <= 700 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: alarm == null ; nothing is sent yet: OUT 0, state once in every frame
; run: steps levels=0,200,201,255,10
; expect: alarm == 0, 0, 1, 1, 0 points=3
; expect: cycles[3] <= 290 points=2
; mistake: alarm == 1, 1, 1, 1, 1 ; the program runs into found also where the loop has ended: jump over it
; mistake: alarm == 0, 1, 1, 1, 0 ; HS takes 200 too: brighter is HI
; mistake: alarm == 0, 0, 1, 1, 1 ; the alarm never ends: set it to 0 in every frame
; mistake: alarm[0] == null ; nothing is sent where no pixel is brighter: the end of the loop leads to OUT as well
; mistake: cycles[0] >= 1100 ; the alarm is sent for every pixel, and OUT takes 8 cycles: send it once a frame, behind the loop
; mistake: cycles[3] >= 600 ; a frame full of light is looked at to its end: JANY leaves the loop at the first bright pixel, and nothing goes back
; run: drawn frames=shapes_drawn
; expect: alarm == 1
; run: dim frames=coin_slide
; expect: alarm == 0 points=2
; mistake: alarm[any] == 1 ; no pixel of this clip is brighter than 172: what else sets the alarm?
