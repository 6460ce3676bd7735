; solution.s - the brightest pixel of every NP
;
; A better one would save the loop: with `.rept 8` around load, compare and mask, and an ADD of its
; own each, the end of the loop comes 8 times a frame and not 64 times. 112 cycles for 42 words.
;
; The hidden checks:
; expect: words <= 16
; expect: cycles <= 820 points=2
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
