; checks.s - what npchip learn check looks at
;
; expect: words <= 28
; expect: cycles <= 860 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: near == null ; nothing is sent yet: OUT 0, near behind the loop and the four neighbours
; run: steps levels=100,99,100
; expect: near == 0, 255, 0
; mistake: near[0] == 255 ; a pixel of 100 is not darker than 100: LO, not LS
; mistake: near[2] == 255 ; what an earlier frame had is kept: begin with 0 in every frame
; run: alone frames=mouse_run first=1
; expect: near[0][5, 4] == 255
; mistake: near[0][5, 4] == 0 ; an NP with a dark pixel of its own counts too: near begins with a copy of mine
; run: drawn frames=shapes_drawn
; expect: near[3][0, 4] == 255
; expect: sum(near[0]) == 12750 points=2
; expect: sum(near[1]) == 15300
; expect: sum(near[3]) == 14280 points=2
; mistake: sum(near[1]) == 9180 ; these are the NPs with dark pixels alone: their neighbours belong to them
; mistake: near[1][7, 1] == 255 ; it spreads round corners: read all four neighbours from mine, collect in near
; mistake: sum(near[1]) == 13770 ; one of the four neighbours is missing
