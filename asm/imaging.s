; imaging.s - a picture with correlated double sampling
;
; Every pixel is converted twice, once after reset and once exposed. The difference is the light
; alone: each pixel's own offset is in both. Where noise makes it negative it becomes 0.
;
; Output    picture   picture   signal - reset of every pixel, at least 0
; Words     15
; Cycles    1,603 per frame (default), 2,948 (conservative)
; Thesis    1.3 and 2.1.1: imaging and correlated double sampling

; Tests     npchip test asm/imaging.s
;
; run: levels levels=0,1,127,128,255
; expect: picture == 0, 1, 127, 128, 255
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.equ SIGNAL, 0                  ; banks of the NP's memory
.equ RESET,  64

.output picture, 0, picture
.budget words  15
.budget cycles 1603

.reg pixel, r0                  ; 8*y + x, the same in every NP
.reg f,     r1
.reg dark,  r2

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     pixel, #0
.pixel: LD      f, [pixel + SIGNAL]
        LD      dark, [pixel + RESET]
        SUB     f, dark
        WHERE   LO              ; the subtraction has borrowed
          MOV   f, #0
        END
        OUT     0, f
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .pixel
        JMP     frame
