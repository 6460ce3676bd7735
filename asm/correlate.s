; correlate.s - how well the pixels of every NP match a template: block cross-correlation
;
; With correlated double sampling. Every NP multiplies its 64 pixels by the 64 numbers of its
; template and adds the products, exactly. There is no multiplication: a product of 8 x 8 bits is
; eight additions, each of the pixel or of 0 as the next bit of the template says, with a shift of
; the whole product between them.
;
; This is one position. A search for the best match has 64 of them, as the template may lie at any
; place between the NPs: about 64 times the cycles between sampling and output, for a single
; template in one size and one orientation.
;
; The host writes the template before the run: 64 bytes for each NP from TEMPLATE on, number (y, x)
; at 8*y + x (--memory 128=template.npy, of shape 64 x NP rows x NP columns).
;
; Outputs   low         plane   sum of pixel * template of the NP, 22 bits: low byte
;           middle      plane   its middle byte
;           high        plane   its high byte
; Words     421
; Cycles    3,822 per frame (default), 4,575 (conservative)
; Thesis    3.2.2: recognition by cross-correlation, which is too slow for the chip

; Tests     npchip test asm/correlate.s
;
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative memory=128=../examples/templates/disc.npy
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative memory=128=../examples/templates/disc.npy
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative memory=128=../examples/templates/disc.npy
; expect: golden cycles

.output low,    0, plane
.output middle, 1, plane
.output high,   2, plane
.budget words  421
.budget cycles 3822

.equ SIGNAL,   0                ; banks of the NP's memory
.equ RESET,    64
.equ TEMPLATE, 128

.reg pixel,  r0                 ; 8*y + x, the same in every NP
.reg f,      r1
.reg number, r2                 ; of the template; bit by bit the low byte of the product instead
.reg top,    r3                 ; high byte of the product
.reg t,      r4
.reg low,    r5
.reg middle, r6
.reg high,   r7

.include "lib/cds.s"

; top:number := f * number. The bits of number leave on the right, through the carry, while the
; product comes in from the left.
.macro multiply
        SHR     number, #1
        SBC     top, top        ; the first bit: 255 where it is set
        AND     top, f
        SHR     top, #1
        RCR     number
        .rept 7
        SBC     t, t
        AND     t, f
        ADD     top, t
        RCR     top             ; the ninth bit of the sum comes from the carry
        RCR     number
        .endr
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     low, #0
        MOV     middle, #0
        MOV     high, #0
        MOV     pixel, #0
.eight: .rept 8
        cds     f, pixel, t
        LD      number, [pixel + TEMPLATE]
        multiply
        ADD     low, number
        ADC     middle, top
        ADC     high, #0
        ADD     pixel, #1
        .endr
        CMP     pixel, #64
        JANY    LO, .eight
        OUT     0, low
        OUT     1, middle
        OUT     2, high
        JMP     frame
