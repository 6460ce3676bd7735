; solution.s - the brightest pixel of the picture
;
; A better one would be a routine: it is needed again and again, for the smallest number (255 minus
; the largest of 255 - x) and for places. asm/lib/maximum.s of npchip is one.
;
; expect: words <= 60
; expect: cycles <= 860 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: most == null ; nothing is sent yet: ask for eight bits, then OUT 0, most
; run: steps levels=0,1,128,255,77
; expect: most == 0, 1, 128, 255, 77 points=2
; mistake: most == 0, 1, 129, 255, 255 ; bits of an earlier frame are kept: most begins with 0 in every frame
; mistake: most == 0, 128, 1, 255, 178 ; the bits are in reverse order: the first question is for 0x80
; mistake: most[4] == 128 ; every question adds the same bit: OR most, #0x80 >> bit
; run: photo frames=city_night first=3
; expect: most == 254, 254, 253 points=3
; mistake: most == 235, 222, 220 ; that is the largest of the last pixels: ask for the bits of best, not of value
; mistake: most == 255 ; that is every bit that any NP has: NPs without the highest one must drop out
; run: coin frames=coin_slide
; expect: golden outputs points=3
; run: mouse frames=mouse_run
; expect: golden outputs
; mistake: most[0] == 255 ; that is every bit that any NP has: NPs without the highest one must drop out

.output most, 0, scalar
.reg pixel, r0
.reg value, r1
.reg best, r2
.reg most, r3
.reg t, r4
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     best, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     best, value
        WHERE   LO
          MOV   best, value
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     most, #0
        .rept 8, bit
          SHL   best, #1
          JNONE CS, .clear
          SBC   t, t
          AND   best, t
          OR    most, #0x80 >> bit
.clear:
        .endr
        OUT     0, most
        JMP     frame
