; checks.s - what npchip learn check looks at
;
; expect: words <= 60
; expect: cycles <= 860 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: error == NP310 ; only the NP at the lower right has the sum: the others must be switched off when it is sent
; mistake: nps == null ; nothing is sent yet: OUT 0, sum in the last NP
; run: steps levels=100,99,100
; expect: nps == 0, 80, 0 points=2
; mistake: nps[1] == 176 ; 255 a dark NP: sums of them wrap, so let t be 1
; mistake: nps[1] == 99 ; one step too many: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[1] == 72 ; one step too few: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[1] == 70 ; one step too few: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[1] == 8 ; that is the sum of the last column: the rows must be added up first
; mistake: nps[1] == 10 ; that is the sum of the last row: copy sum to t, then walk from the north
; mistake: nps[1] == 17 ; the second walk carries what the first one has left in t: MOV t, sum goes before it
; mistake: nps[0] != 0 ; a pixel of 100 is not darker than 100: LO, not LS
; mistake: nps[2] != 0 ; what an earlier frame had is kept: begin with 0 in every frame
; run: drawn frames=shapes_drawn
; expect: nps[0] == 30 points=2
; expect: nps[3] == 40
