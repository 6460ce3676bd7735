; solution.s - a chess board
;
; A better one would make 255 of the lowest bit without a mask: `SHR r0, #1` moves it into C, and
; `SBC r0, r0` turns C into 255 or 0. Seven words instead of ten.
;
; expect: words <= 12
; expect: cycles <= 20 points=2
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
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
; mistake: sum(board[setup]) == 20145 ; all but one are white: AND #1 keeps the lowest bit alone, and WHERE NE must follow that
; mistake: board[setup][7, 9] == 255 ; NP (7, 9) is white, whose row plus column is 16: add both, then look at the lowest bit of the sum
; run: again machine=default
; expect: golden outputs points=3

.output board, 0, plane
        ROW     r0
        COL     r1
        ADD     r0, r1
        AND     r0, #1
        MOV     r0, #0
        WHERE   NE
          MOV   r0, #255
        END
        OUT     0, r0
        HALT
