; solution.s - is any pixel brighter than 200?
;
; A better one would ask the wire less often: JANY costs 4 cycles on the machine `conservative`.
; Let each NP keep the largest of eight pixels, and ask once for all of them.
;
; expect: words <= 16
; expect: cycles <= 700 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: alarm == null ; nothing is sent yet: OUT 0, state once in every frame
; run: steps levels=0,200,201,255,10
; expect: alarm == 0, 0, 1, 1, 0 points=3
; expect: cycles[3] <= 290 points=2
; mistake: alarm == 1, 1, 1, 1, 1 ; the program runs into found also where the loop has ended: jump over it
; mistake: alarm == 0, 1, 1, 1, 0 ; HS takes 200 too: brighter is HI
; mistake: alarm == 0, 0, 1, 1, 1 ; the alarm never ends: set it to 0 in every frame
; mistake: alarm[0] == null ; nothing is sent where no pixel is brighter: the end of the loop leads to OUT as well
; mistake: cycles[0] >= 1100 ; the alarm is sent for every pixel, and OUT takes 8 cycles: send it once a frame, behind the loop
; mistake: cycles[3] >= 600 ; a frame full of light is looked at to its end: JANY leaves the loop at the first bright pixel, and nothing goes back
; run: drawn frames=shapes_drawn
; expect: alarm == 1
; run: dim frames=coin_slide
; expect: alarm == 0 points=2
; mistake: alarm[any] == 1 ; no pixel of this clip is brighter than 172: what else sets the alarm?
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: city frames=city_night first=40
; expect: golden outputs
; run: mouse frames=mouse_run first=10
; expect: golden outputs
; run: spots frames=spots.gif
; expect: golden outputs
; run: grey levels=0,60,200
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
