; checks.s - what npchip learn check looks at
;
; expect: words <= 32
; expect: cycles <= 1850 points=2
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame: one for each pixel of an NP
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: edges == null ; nothing is sent yet: 64 pixels a frame, row by row
; run: flat levels=200
; expect: edges[0][0.., 0] == 200
; expect: edges[0][0.., 1..] == 0 points=2
; mistake: edges[0][0.., 8] == 200 ; a forgotten halo: the first column of every NP has a neighbour in the NP west of it
; mistake: edges[0] == 200 ; the pixels are sent as they are: subtract the western neighbour
; mistake: edges[0][0, 7] == 200 ; NBR gives the same pixel of the western NP: only the first pixel of a row needs it, for the others keep the pixel before
; run: drawn frames=shapes_drawn
; expect: sum(edges[0]) == 37570 points=2
; expect: edges[1][31, 24] == 0
; expect: edges[1][20, 60] == 36
; mistake: sum(edges[1]) == 23104 ; negative differences wrap round: take the absolute value
; mistake: sum(edges[1]) == 42552 ; the halo must come from the western NP: is it read by NBR?
; mistake: sum(edges[1]) == 10638 ; edges of one kind are missing: a negative difference counts as well
