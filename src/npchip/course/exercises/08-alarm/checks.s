; checks.s - what npchip learn check looks at
;
; expect: words <= 16
; expect: cycles <= 700 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE stays open: each needs its END before the program jumps back
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared?
; mistake: alarm == null ; nothing is sent yet: OUT 0, state once in every frame
; run: steps levels=0,200,201,255,10
; expect: alarm == 0, 0, 1, 1, 0 points=3
; expect: cycles[3] <= 290 points=2
; mistake: alarm == 1, 1, 1, 1, 1 ; the program runs into found also where the loop has ended: jump over it
; mistake: alarm == 0, 1, 1, 1, 0 ; HS takes 200 too: brighter is HI
; mistake: alarm == 0, 0, 1, 1, 1 ; the alarm never ends: set it to 0 in every frame
; run: drawn frames=shapes_drawn
; expect: alarm == 1
; run: dim frames=coin_slide
; expect: alarm == 0 points=2
; mistake: alarm[any] == 1 ; no pixel of this clip is brighter than 172: compare with 200
