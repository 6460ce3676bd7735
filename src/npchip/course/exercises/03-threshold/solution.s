; solution.s - 255 where a pixel is brighter than 128
;
; A better one would need no mask: `MOV t, #128`, `SUB t, value` sets C where 128 < value, and
; `SBC t, t` turns C into 255 or 0. Three instructions instead of five, 128 cycles less a frame.
;
; expect: words <= 16
; expect: cycles <= 1350 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: steps levels=0,127,128,129,255
; expect: bright == 0, 0, 0, 255, 255 points=3
; mistake: bright == 0, 127, 128, 129, 255 ; the pixels are sent as they are: compare them, then use WHERE
; mistake: bright == 0, 0, 255, 255, 255 ; HS takes the limit itself too: brighter is HI
; mistake: bright == 0 ; everything is black: the value is set to 0 before it is compared
; mistake: bright == 0, 127, 128, 255, 255 ; what is not brighter is sent as it is: give 0 to all NPs, between CMP and WHERE
; mistake: bright == 0, 0, 128, 255, 255 ; 128 itself is in neither region: LO leaves it out, LS takes it too
; mistake: bright == 255, 255, 255, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; mistake: bright == 255, 255, 0, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; mistake: cycles >= 1351 ; a second region, or ELSE, costs 64 cycles for each of its lines: give 0 to all NPs first, then 255 to some
; run: drawn frames=shapes_drawn
; expect: sum(bright[0]) == 1007505
; expect: bright[1][31, 40] == 0
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: all levels=1,64,126,127,128,129,130,254
; expect: golden outputs

.output bright, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #128
        MOV     value, #0
        WHERE   HI
          MOV   value, #255
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
