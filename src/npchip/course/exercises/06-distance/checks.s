; checks.s - what npchip learn check looks at
;
; expect: words <= 18
; expect: cycles <= 1450 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE stays open: each needs its END before the program jumps back
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame: one for each pixel of an NP
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared?
; run: steps levels=0,80,99,100,101,120,255
; expect: distance == 100, 20, 1, 0, 1, 20, 155 points=3
; mistake: distance == 0, 80, 99, 100, 101, 120, 255 ; the pixels are sent as they are: subtract 100 first
; mistake: distance == 156, 236, 255, 0, 1, 20, 155 ; pixels below 100 wrap round: where C is set, turn the result round
; mistake: distance == 0, 0, 0, 0, 1, 20, 155 ; what is darker counts as well: turn a negative result round
; mistake: distance == 99, 19, 0, 0, 1, 20, 155 ; 255 - x is one less than 0 - x
; run: drawn frames=shapes_drawn
; expect: sum(distance[0]) == 722484 points=2
