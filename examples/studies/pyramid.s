; pyramid.s - the first step of an image pyramid: half the resolution, means of 2 x 2 pixels
;
; With correlated double sampling. A mean is rounded, halves up. All pixels of a mean are in one
; NP, and so they are in the two steps that follow (2 x 2 and 1 x 1 means for each NP): no NP needs
; a neighbour. The means are sent as 16 planes, and stay in memory for a next step.
;
; Outputs   mean0 to mean15  plane  mean (y, x) of the NP's 4 x 4 is mean4*y + x
; Words     89
; Cycles    1,440 per frame (default), 2,301 (conservative)
; Thesis    3.2.3: pyramids for recognition at any scale

; Tests     npchip test -I asm examples/studies/pyramid.s
;
; run: coin   frames=../clips/coin_slide.npy machine=default,conservative
; expect: status == frames-exhausted

.output mean0,  0,  plane
.output mean1,  1,  plane
.output mean2,  2,  plane
.output mean3,  3,  plane
.output mean4,  4,  plane
.output mean5,  5,  plane
.output mean6,  6,  plane
.output mean7,  7,  plane
.output mean8,  8,  plane
.output mean9,  9,  plane
.output mean10, 10, plane
.output mean11, 11, plane
.output mean12, 12, plane
.output mean13, 13, plane
.output mean14, 14, plane
.output mean15, 15, plane
.budget words  89
.budget cycles 1440

.equ SIGNAL, 0                  ; banks of the NP's memory
.equ RESET,  64
.equ MEAN,   128

.reg pixel,  r0                 ; 8*y + x, the same in every NP
.reg mean,   r1                 ; place of a mean
.reg f,      r2
.reg low,    r3                 ; sum of four pixels
.reg high,   r4
.reg t,      r5

.include "lib/cds.s"

.macro plus
        cds     f, pixel, t
        ADD     low, f
        ADC     high, #0
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     pixel, #0
        MOV     mean, #0
.mean:  MOV     low, #0
        MOV     high, #0
        plus
        ADD     pixel, #1
        plus
        ADD     pixel, #7
        plus
        ADD     pixel, #1
        plus
        SUB     pixel, #7
        .rept 2
        SHR     high, #1
        RCR     low
        .endr
        ADC     low, #0         ; C: the highest bit that was cut off
        ST      [mean + MEAN], low
        ADD     mean, #1
        MOV     t, mean
        AND     t, #3
        JANY    NE, .mean
        ADD     pixel, #8       ; the next two rows
        CMP     pixel, #64
        JANY    LO, .mean
        .rept 16, number
        LD      f, [MEAN + number]
        OUT     number, f
        .endr
        JMP     frame
