; checks.s - what npchip learn check looks at
;
; expect: words <= 36
; expect: cycles <= 330 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: steps levels=100,110,90,10,250
; expect: next == 100, 120, 70, 0, 255 points=3
; mistake: next == 100, 110, 90, 10, 250 ; that is the present value: next begins as now, its change is added, and next is sent
; mistake: next == 100, 120, 70, 186, 234 ; 8 bits wrap: compute in two bytes, then clamp
; mistake: next == 200, 120, 70, 0, 255 ; the first frame has no predecessor: predict that nothing changes
; mistake: next == 100, 120, 80, 0, 255 ; before is never replaced: it becomes now at the end of every frame
; mistake: next == 100, 90, 130, 170, 0 ; now and before are exchanged: 2 * now - before
; mistake: next == 100, 120, 70, 255, 255 ; below zero it is 0, not 255: high is then 255
; mistake: next == 0, 10, 0, 0, 240 ; now is missing from the sum: next begins as now, by MOV next, now, before now is added to it
; run: drawn frames=shapes_drawn
; expect: sum(next[2]) == 12744 points=2
