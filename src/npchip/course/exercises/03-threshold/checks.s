; checks.s - what npchip learn check looks at
;
; expect: words <= 16
; expect: cycles <= 1350 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE stays open: each needs its END before the program jumps back
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame: one for each pixel of an NP
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared?
; run: steps levels=0,127,128,129,255
; expect: bright == 0, 0, 0, 255, 255 points=3
; mistake: bright == 0, 127, 128, 129, 255 ; the pixels are sent as they are: compare them, then use WHERE
; mistake: bright == 0, 0, 255, 255, 255 ; HS takes the limit itself too: brighter is HI
; mistake: bright == 255, 255, 255, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; mistake: bright == 255, 255, 0, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; run: drawn frames=shapes_drawn
; expect: sum(bright[0]) == 1007505
; expect: bright[1][31, 40] == 0
