; solution.s - 255 where a pixel is brighter than 128, quickly
;
; A better one would need more words: written out 64 times with constant addresses, a pixel takes 12
; cycles, and 5 words, which is 320 in all.
;
; expect: words <= 60
; expect: cycles <= 1120 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: words >= 300 ; 64 copies are fast but long: repeat the body 8 times, in a loop of 8
; run: steps levels=0,127,128,129,255
; expect: bright == 0, 0, 0, 255, 255 points=3
; mistake: bright == 0, 0, 255, 255, 255 ; 128 itself is not brighter than 128
; mistake: bright == 255, 255, 0, 0, 0 ; black and white are exchanged: which of the two numbers is subtracted?
; mistake: bright == 255, 255, 255, 0, 0 ; black and white are exchanged: which of the two numbers is subtracted?
; mistake: cycles >= 1300 ; the mask: SBC t, t makes 255 or 0 of the carry in one cycle
; mistake: cycles >= 1200 ; the loop: its end costs three cycles a pixel, so write its body 8 times with .rept
; run: drawn frames=shapes_drawn
; expect: sum(bright[0]) == 1007505
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: city frames=city_night first=2
; expect: golden outputs

.output bright, 0, picture
.budget cycles 1120
.reg pixel, r0
.reg value, r1
.reg t, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:
        .rept 8
          LD    value, [pixel]
          MOV   t, #128
          SUB   t, value
          SBC   t, t
          OUT   0, t
          ADD   pixel, #1
        .endr
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
