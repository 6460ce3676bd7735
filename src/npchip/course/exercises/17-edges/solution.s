; solution.s - how far every pixel lies from its western neighbour
;
; A better one would write the row out with `.rept 8`: the three instructions that end the inner
; loop are a seventh of its cycles.
;
; expect: words <= 32
; expect: cycles <= 1850 points=2
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame: one for each pixel of an NP
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: edges == null ; nothing is sent yet: 64 pixels a frame, row by row
; run: flat levels=200
; expect: edges[0][0.., 0] == 200
; expect: edges[0][0.., 1..] == 0 points=2
; mistake: edges[0][0.., 8] == 200 ; a forgotten halo: the first column of every NP has a neighbour in the NP west of it
; mistake: edges[0] == 200 ; the pixels are sent as they are: subtract the western neighbour
; mistake: edges[0][0, 7] == 200 ; NBR gives the same pixel of the western NP: only the first pixel of a row needs it, for the others keep the pixel before
; run: drawn frames=shapes_drawn
; expect: sum(edges[0]) == 37570 points=2
; expect: edges[1][31, 24] == 0
; expect: edges[1][20, 60] == 36
; mistake: sum(edges[1]) == 23104 ; negative differences wrap round: take the absolute value
; mistake: sum(edges[1]) == 42552 ; the halo must come from the western NP: is it read by NBR?
; mistake: sum(edges[1]) == 10638 ; edges of one kind are missing: a negative difference counts as well
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: city frames=city_night first=2
; expect: golden outputs

.output edges, 0, picture
.reg pixel, r0
.reg value, r1
.reg left, r2
.reg t, r3
.macro absdiff a, b, t
        MOV     t, b
        SUB     t, a
        SUB     a, b
        WHERE   LO
          MOV   a, t
        END
.endm
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.row:   ADD     pixel, #7
        LD      value, [pixel]
        NBR     left, value, west
        SUB     pixel, #7
.next:  LD      value, [pixel]
        absdiff left, value, t
        OUT     0, left
        MOV     left, value
        ADD     pixel, #1
        MOV     t, pixel
        AND     t, #7
        JANY    NE, .next
        CMP     pixel, #64
        JANY    LO, .row
        JMP     frame
