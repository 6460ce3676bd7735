; checks.s - what npchip learn check looks at
;
; expect: words <= 16
; expect: cycles <= 1350 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: steps levels=0,127,128,129,255
; expect: bright == 0, 0, 0, 255, 255 points=3
; mistake: bright == 0, 127, 128, 129, 255 ; the pixels are sent as they are: compare them, then use WHERE
; mistake: bright == 0, 0, 255, 255, 255 ; HS takes the limit itself too: brighter is HI
; mistake: bright == 0 ; everything is black: the value is set to 0 before it is compared
; mistake: bright == 0, 127, 128, 255, 255 ; what is not brighter is sent as it is: give 0 to all NPs, between CMP and WHERE
; mistake: bright == 0, 0, 128, 255, 255 ; 128 itself is in neither region: LO leaves it out, LS takes it too
; mistake: bright == 255, 255, 255, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; mistake: bright == 255, 255, 0, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; mistake: cycles >= 1351 ; a second region, or ELSE, costs 64 cycles for each of its lines: give 0 to all NPs first, then 255 to some
; run: drawn frames=shapes_drawn
; expect: sum(bright[0]) == 1007505
; expect: bright[1][31, 40] == 0
