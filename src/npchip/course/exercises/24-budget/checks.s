; checks.s - what npchip learn check looks at
;
; expect: words <= 60
; expect: cycles <= 1120 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: words >= 300 ; 64 copies are fast but long: repeat the body 8 times, in a loop of 8
; run: steps levels=0,127,128,129,255
; expect: bright == 0, 0, 0, 255, 255 points=3
; mistake: bright == 0, 0, 255, 255, 255 ; 128 itself is not brighter than 128
; mistake: bright == 255, 255, 0, 0, 0 ; black and white are exchanged: which of the two numbers is subtracted?
; mistake: bright == 255, 255, 255, 0, 0 ; black and white are exchanged: which of the two numbers is subtracted?
; mistake: cycles >= 1300 ; the mask: SBC t, t makes 255 or 0 of the carry in one cycle
; mistake: cycles >= 1200 ; the loop: its end costs three cycles a pixel, so write its body 8 times with .rept
; run: drawn frames=shapes_drawn
; expect: sum(bright[0]) == 1007505
