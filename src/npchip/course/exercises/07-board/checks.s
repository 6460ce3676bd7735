; checks.s - what npchip learn check looks at
;
; expect: words <= 12
; expect: cycles <= 20 points=2
; mistake: error == NP020 ; a WHERE stays open: each needs its END before the program jumps back
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared?
; mistake: error == NP305 ; the program runs past its last word: HALT ends it
; run: once
; expect: board[setup][0, 0] == 0
; expect: board[setup][0, 1] == 255
; expect: board[setup][1, 0] == 255
; expect: board[setup][7, 9] == 0
; expect: sum(board[setup]) == 10200 points=2
; mistake: sum(board[setup]) == 280 ; that is the row alone: COL gives the column, ADD adds it
; mistake: sum(board[setup]) == 640 ; that is row + column: AND #1 keeps the lowest bit alone
; mistake: sum(board[setup]) == 40 ; the pattern is right, but white is 255, not 1
; mistake: board[setup][0, 0] == 255 ; black and white are exchanged: which NPs does your condition keep?
