; checks.s - what npchip learn check looks at
;
; expect: words <= 130
; expect: cycles <= 1050 points=2
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: col == null ; nothing is sent yet as col: row goes to port 0, col to port 1
; run: flat levels=255,50
; expect: row == 255, 0
; expect: col == 255, 0 points=2
; mistake: col[0] == 7 ; in an empty picture the column is 255 as well: NPs without a pixel take no part
; run: drawn frames=shapes_drawn
; expect: row == 8, 11, 6, 5 points=2
; expect: col == 38, 22, 37, 39 points=3
; mistake: col[1] == 19 ; that is the first column of all: only NPs with a pixel in that row take part
; mistake: col[1] <= 7 ; a column within its NP: add 8 times the number of the NP's column
; mistake: row[1] == 22 ; row and column are exchanged
