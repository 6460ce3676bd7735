; solution.s - the brightness of a pixel, one frame ahead
;
; A better one would use that only two frames are needed to know a speed, but three to know how it
; changes: asm/trajectory_nonlinear.s of npchip. A mean of several speeds is calmer where there is
; noise.
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
; run: mouse frames=mouse_run first=20
; expect: golden outputs points=3
; run: city frames=city_night first=8
; expect: golden outputs

.output next, 0, plane
.reg now, r0
.reg before, r1
.reg next, r2
.reg high, r3
.reg seen, r4
        MOV     seen, #0
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      now, [0]
        CMP     seen, #0
        WHERE   EQ
          MOV   before, now
        END
        MOV     next, now
        MOV     high, #0
        ADD     next, now
        ADC     high, #0
        SUB     next, before
        SBC     high, #0
        CMP     high, #0
        WHERE   NE
          MOV   next, #255
          CMP   high, #1
          WHERE NE
            MOV next, #0
          END
        END
        OUT     0, next
        MOV     before, now
        MOV     seen, #1
        JMP     frame
