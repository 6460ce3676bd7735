; solution.s - 255 where a pixel is brighter than 128
;
; A better one would need no mask: `MOV t, #128`, `SUB t, value` sets C where 128 < value, and
; `SBC t, t` turns C into 255 or 0. Three instructions instead of five, 128 cycles less a frame.
;
; The hidden checks:
; expect: words <= 16
; expect: cycles <= 1350 points=2
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
