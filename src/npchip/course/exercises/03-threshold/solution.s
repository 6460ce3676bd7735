; solution.s - 255 where a pixel is brighter than 128
;
; A better one would need no mask: `MOV t, #128`, `SUB t, value` sets C where 128 < value, and
; `SBC t, t` turns C into 255 or 0. Three instructions instead of five, 128 cycles less a frame.
;
; expect: words <= 16
; expect: cycles <= 1350 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE stays open: each needs its END before the program jumps back
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame: one for each pixel of an NP
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared?
; run: steps levels=0,127,128,129,255
; expect: bright == 0, 0, 0, 255, 255 points=3
; mistake: bright == 0, 127, 128, 129, 255 ; the pixels are sent as they are: compare them, then use WHERE
; mistake: bright == 0, 0, 255, 255, 255 ; HS takes the limit itself too: brighter is HI
; mistake: bright == 255, 255, 255, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; mistake: bright == 255, 255, 0, 0, 0 ; black and white are exchanged: which NPs does your condition keep?
; run: drawn frames=shapes_drawn
; expect: sum(bright[0]) == 1007505
; expect: bright[1][31, 40] == 0
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: all levels=1,64,126,127,128,129,130,254
; expect: bright == 0, 0, 0, 0, 0, 255, 255, 255

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
