; checks.s - what npchip learn check looks at
;
; expect: words <= 94
; expect: cycles <= 880 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: error == NP311 ; a scalar16 takes two sends a frame, the low byte and the high one
; mistake: error == NP310 ; only the NP at the lower right has the sum: the others must be switched off when it is sent
; mistake: dark == null ; nothing is sent yet: two bytes, the low one first, in the last NP
; run: steps levels=100,99,100
; expect: dark == 0, 5120, 0 points=2
; mistake: dark[1] == 0 ; only the low byte is added up: 5,120 is 20 times 256 and 0, so ADC must go on in the high one
; mistake: dark[1] == 1024 ; carries along the rows are lost: ADC high, #0 after each ADD
; mistake: dark[1] == 20 ; the bytes are exchanged: the low one is sent first
; mistake: dark[1] == 80 ; these are NPs, not pixels: count all pixels
; mistake: dark[0] != 0 ; a pixel of 100 is not darker than 100: LO, not LS
; mistake: dark[2] != 0 ; what an earlier frame had is kept: begin with 0 in every frame
; run: drawn frames=shapes_drawn
; expect: dark[0] == 1156 points=2
; expect: dark[3] == 1608
