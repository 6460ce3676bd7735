; checks.s - what npchip learn check looks at
;
; expect: words <= 24
; expect: cycles <= 1400 points=2
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame: one for each pixel of an NP
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: shifted == null ; nothing is sent yet: 64 pixels a frame, row by row
; run: flat levels=200
; expect: shifted[0][0.., 0] == 0
; expect: shifted[0][0.., 1..] == 200 points=2
; mistake: shifted[0] == 200 ; the first column must be 0: NBR gives that, outside the array
; mistake: shifted[0][0.., 8] == 0 ; a forgotten halo: the first column of every NP needs its western neighbour's last
; mistake: shifted[0][0.., 72] == 0 ; the halo comes from the wrong side: what moves to the right comes from the west
; mistake: shifted[0][0, 7] == 0 ; NBR gives the same pixel of the western NP: only the first pixel of a row needs it, for the others keep the pixel before
; mistake: shifted[0][1, 0] == 200 ; left is what the row above has left behind: each row begins with NBR from the west
; run: drawn frames=shapes_drawn
; expect: sum(shifted[0]) == 991152 points=2
; expect: shifted[0][47, 18] == 0
; expect: shifted[1][31, 24] == 0
