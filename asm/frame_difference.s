; frame_difference.s - how much every pixel has changed since the frame before
;
; With correlated double sampling. Numbers are unsigned, so the smaller is always taken from the
; larger. The first frame has no predecessor: its difference is 0.
;
; Output    difference   picture   |f(t) - f(t-1)| of every pixel
; Words     29
; Cycles    2,372 per frame (default), 3,845 (conservative)
; Thesis    2.1.1: frame differencing

; Tests     npchip test asm/frame_difference.s
;
; run: levels levels=10,50,50,20,255,0
; expect: difference == 0, 40, 0, 30, 235, 255
; run: moving frames=../examples/clips/coin_slide.npy first=9
; expect: golden outputs
; expect: max(difference[0]) == 0
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.equ SIGNAL,   0                ; banks of the NP's memory
.equ RESET,    64
.equ PREVIOUS, 128

.output difference, 0, picture
.budget words  29
.budget cycles 2372

.reg pixel,  r0                 ; 8*y + x, the same in every NP
.reg f,      r1                 ; this frame
.reg before, r2                 ; the frame before
.reg change, r3
.reg first,  r4                 ; 1 in the first frame

        MOV     first, #1
frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     pixel, #0

.pixel: LD      f, [pixel + SIGNAL]
        LD      before, [pixel + RESET]
        SUB     f, before       ; correlated double sampling
        WHERE   LO
          MOV   f, #0
        END
        LD      before, [pixel + PREVIOUS]
        CMP     first, #1
        WHERE   EQ
          MOV   before, f
        END
        ST      [pixel + PREVIOUS], f
        MOV     change, f
        SUB     change, before
        WHERE   LO              ; it has become darker
          MOV   change, before
          SUB   change, f
        END
        OUT     0, change
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .pixel

        MOV     first, #0
        JMP     frame
