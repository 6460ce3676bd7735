; checks.s - what npchip learn check looks at
;
; expect: words <= 60
; expect: cycles <= 860 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE stays open: each needs its END before the program jumps back
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared?
; mistake: error == NP310 ; only the NP at the lower right has the sum: the others must be switched off when it is sent
; mistake: nps == null ; nothing is sent yet: OUT 0, sum in the last NP
; run: steps levels=99,100
; expect: nps == 80, 0 points=2
; mistake: nps[0] == 176 ; 255 a dark NP: sums of them wrap, so let t be 1
; mistake: nps[0] == 99 ; one step too many: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[0] == 72 ; one step too few: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[0] == 70 ; one step too few: 10 columns are nine steps apart, 8 rows seven
; mistake: nps[0] == 8 ; that is the sum of the last column: the rows must be added up first
; mistake: nps[0] == 10 ; that is the sum of the last row: copy sum to t, then walk from the north
; mistake: nps[1] != 0 ; something is kept from an earlier frame, or 100 counts as darker than 100
; run: drawn frames=shapes_drawn
; expect: nps[0] == 30 points=2
; expect: nps[3] == 40
