; checks.s - what npchip learn check looks at
;
; expect: words <= 18
; expect: cycles <= 800 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: mean == null ; nothing is sent yet: sum up in two registers, shift, send
; run: steps levels=100,255,1,7
; expect: mean == 100, 255, 1, 7 points=3
; mistake: mean == 0, 3, 1, 3 ; 8 bits are not enough for the sum: ADC high, #0 goes on, directly behind ADD low, value
; mistake: mean == 100, 252, 0, 4 ; the two highest bits of the low byte are missing: SHR low, #6, then OR
; mistake: mean == 25, 63, 0, 1 ; that is the sum divided by 256: six bits to the right, not eight
; mistake: mean == 200, 254, 2, 14 ; a bit too far to the left: by 6 down, by 2 up
; mistake: mean[0] != 100 ; the high byte belongs above the two bits that SHR low, #6 has left: SHL high, #2
; run: drawn frames=shapes_drawn
; expect: mean[0][6, 2] == 222
; expect: sum(mean[0]) == 15730 points=2
