; checks.s - what npchip learn check looks at
;
; expect: words <= 16
; expect: cycles <= 820 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: dark == null ; nothing is sent yet: OUT 0, dark after the loop
; run: steps levels=99,100,0,255
; expect: dark == 64, 0, 64, 0 points=3
; mistake: dark == 64, 64, 128, 128 ; the counter goes on from frame to frame: set it to 0 behind EXPOSE
; mistake: dark == 64, 64, 64, 0 ; a pixel of 100 is not darker than 100: LO, not LS
; mistake: dark == 0, 64, 0, 64 ; the others are counted: which NPs does your condition keep?
; mistake: dark == 1, 0, 1, 0 ; one pixel is counted, not 64: is the counter set to 0 inside the loop?
; mistake: dark == 99, 100, 0, 255 ; that is the last pixel: after the loop send the counter
; run: drawn frames=shapes_drawn
; expect: dark[0][4, 5] == 64
; expect: dark[0][6, 2] == 8
; expect: sum(dark[0]) == 1156 points=2
