; solution.s - the brightest pixel of every NP
;
; A better one would save the loop: with `.rept 8` around load, compare and mask, and an ADD of its
; own each, the end of the loop comes 8 times a frame and not 64 times. 112 cycles for 42 words.
;
; expect: words <= 16
; expect: cycles <= 820 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: most == null ; nothing is sent yet: OUT 0, most after the loop
; run: steps levels=50,200,10,0
; expect: most == 50, 200, 10, 0 points=3
; mistake: most == 50, 200, 200, 200 ; the best of an earlier frame is kept: begin with 0 in every frame
; mistake: most == 0 ; nothing ever replaces the 0: compare most with value, and keep the NPs in which it is lower
; run: drawn frames=shapes_drawn
; expect: most[0][4, 5] == 0
; expect: most[0][0, 0] == 255
; expect: sum(most[0]) == 17800 points=2
; mistake: most[0][3, 6] == 0 ; in NP (3, 6) that is the darkest pixel: which one does your mask keep?
; mistake: most[0][3, 6] == 2 ; in NP (3, 6) that is the last pixel: keep the best so far where it is not lower
; run: mouse frames=mouse_run first=20
; expect: golden outputs points=3
; run: city frames=city_night first=5
; expect: golden outputs

.output most, 0, plane
.reg pixel, r0
.reg value, r1
.reg most, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     most, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     most, value
        WHERE   LO
          MOV   most, value
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        OUT     0, most
        JMP     frame
