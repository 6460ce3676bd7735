; solution.s - the mean of the pixels of every NP
;
; A better one would round. Shift the high byte first: then the bit that SHR moves out of the low
; byte last is still in C behind the OR, and `ADC low, #0` adds it.
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
; run: mouse frames=mouse_run first=20
; expect: golden outputs points=3
; run: city frames=city_night first=5
; expect: golden outputs

.output mean, 0, plane
.reg pixel, r0
.reg value, r1
.reg low, r2
.reg high, r3
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     low, #0
        MOV     high, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        ADD     low, value
        ADC     high, #0
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        SHR     low, #6
        SHL     high, #2
        OR      low, high
        OUT     0, low
        JMP     frame
