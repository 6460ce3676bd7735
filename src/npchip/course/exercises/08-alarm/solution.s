; solution.s - is any pixel brighter than 200?
;
; A better one would ask the wire less often: JANY costs 4 cycles on the machine `conservative`.
; Let each NP keep the largest of eight pixels, and ask once for all of them.
;
; The hidden checks:
; expect: words <= 16
; expect: cycles <= 700 points=2
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: city frames=city_night first=40
; expect: golden outputs
; run: mouse frames=mouse_run first=10
; expect: golden outputs
; run: spots frames=spots.gif
; expect: alarm == 1
; run: dim levels=0,60,200
; expect: golden outputs

.output alarm, 0, scalar
.reg pixel, r0
.reg value, r1
.reg state, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     state, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #200
        JANY    HI, found
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     send
found:  MOV     state, #1
send:   OUT     0, state
        JMP     frame
