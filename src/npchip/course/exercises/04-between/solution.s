; solution.s - 255 where 64 <= value <= 192
;
; A better one would compare once: value - 64 wraps round for what lies below 64, so that
; value - 64 <= 128, unsigned, says both. `SUB value, #64`, `CMP value, #129`, and `SBC out, out`
; makes 255 of the carry: no mask at all.
;
; The hidden checks:
; expect: words <= 20
; expect: cycles <= 1600 points=2
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: coin frames=coin_slide first=8
; expect: golden outputs

.output middle, 0, picture
.reg pixel, r0
.reg value, r1
.reg out, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        MOV     out, #0
        CMP     value, #64
        WHERE   HS
          CMP   value, #192
          WHERE LS
            MOV out, #255
          END
        END
        OUT     0, out
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
