; checks.s - what npchip learn check looks at
;
; expect: words <= 16
; expect: cycles <= 820 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: most == null ; nothing is sent yet: OUT 0, most after the loop
; run: steps levels=50,200,10,0
; expect: most == 50, 200, 10, 0 points=3
; mistake: most == 50, 200, 200, 200 ; the best of an earlier frame is kept: begin with 0 in every frame
; mistake: most == 0 ; nothing ever replaces the 0: compare most with value, and keep the NPs in which it is lower
; run: drawn frames=shapes_drawn
; expect: most[0][4, 5] == 0
; expect: most[0][0, 0] == 255
; expect: sum(most[0]) == 17800 points=2
; mistake: most[0][3, 6] == 0 ; in NP (3, 6) that is the darkest pixel: which one does your mask keep?
; mistake: most[0][3, 6] == 2 ; in NP (3, 6) that is the last pixel: keep the best so far where it is not lower
