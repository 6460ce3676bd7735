; solution.s - the picture, a pixel to the right
;
; A better one would write the row out: `.rept 8` instead of the inner loop saves the three
; instructions that end it, at every pixel.
;
; The hidden checks:
; expect: words <= 24
; expect: cycles <= 1400 points=2
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: city frames=city_night first=2
; expect: golden outputs

.output shifted, 0, picture
.reg pixel, r0
.reg value, r1
.reg left, r2
.reg t, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.row:   ADD     pixel, #7
        LD      value, [pixel]
        NBR     left, value, west
        SUB     pixel, #7
.next:  LD      value, [pixel]
        OUT     0, left
        MOV     left, value
        ADD     pixel, #1
        MOV     t, pixel
        AND     t, #7
        JANY    NE, .next
        CMP     pixel, #64
        JANY    LO, .row
        JMP     frame
