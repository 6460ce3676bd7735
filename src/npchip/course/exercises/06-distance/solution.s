; solution.s - how far every pixel lies from 100
;
; A better one would turn a number round without a mask: after SUB, `SBC t, t` is -1 or 0, and
; (value ^ t) - t does either. But there is no XOR, so that only the loop can be shortened, with
; `.rept 8` around its body.
;
; The hidden checks:
; expect: words <= 18
; expect: cycles <= 1450 points=2
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: mouse frames=mouse_run first=2
; expect: golden outputs

.output distance, 0, picture
.reg pixel, r0
.reg value, r1
.reg other, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        SUB     value, #100
        WHERE   LO
          MOV   other, value
          MOV   value, #0
          SUB   value, other
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
