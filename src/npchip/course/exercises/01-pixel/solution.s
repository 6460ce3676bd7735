; solution.s - the first pixel of every NP
;
; Nothing can be saved: each of the five instructions is needed, and 256 of the cycles are the
; conversion. A frame costs that much even where only one pixel is used.
;
; expect: words <= 8
; expect: cycles <= 300 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: corner == null ; nothing is sent yet: LD loads a byte, OUT sends it
; run: levels levels=10,200
; expect: corner == 10, 200 points=2
; mistake: cycles <= 255 ; the memory still holds 0: SAMPLE converts the pixels into it
; mistake: corner == 0 ; that is another register than the one that LD loads the first pixel into
; mistake: corner == 0, 10 ; the byte is sent before it is loaded: OUT comes after LD
; run: drawn frames=shapes_drawn
; expect: corner[0][4, 5] == 0 points=2
; expect: corner[0][0, 0] == 255
; expect: sum(corner[0]) == 15151
; mistake: corner[0][3, 5] != 255 ; a byte is sent, but not the first pixel: it lies at address 0
; run: city frames=city_night first=6
; expect: golden outputs points=3
; run: coin frames=coin_slide
; expect: golden outputs

.output corner, 0, plane
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        OUT     0, r0
        JMP     frame
