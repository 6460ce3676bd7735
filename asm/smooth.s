; smooth.s - 3 x 3 binomial filter: every pixel becomes a weighted mean of its surroundings
;
;       1 2 1          1
;       2 4 2 / 16  =  2 / 4  along the columns, then  1 2 1 / 4  along the rows
;       1 2 1          1
;
; With correlated double sampling; pixels outside the frame are 0. And 1 2 1 is 1 1 twice: of
; three numbers that follow each other, the sum of the first two and the sum of the last two are
; added, and the last sum serves again one step further. Sums have 12 bits and are rounded once,
; half up. Both borders of an NP are fetched from its neighbours; the corners come with the sums
; of columns, so that no pixel has to be sent through two NPs.
;
; Output    smooth    picture   (weighted sum + 8) >> 4
; Words     236
; Cycles    2,811 per frame (default), 4,332 (conservative)
; Thesis    1.3: filtering

; Tests     npchip test asm/smooth.s
;
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.output smooth, 0, picture
.budget words  236
.budget cycles 2811

; The sums of columns take the place of the samples: that of row y lies where the sample of row
; y + 1 has been read by then.
.equ SIGNAL, 0
.equ RESET,  128
.equ LOW,    0                  ; bytes 8 to 71
.equ HIGH,   128                ; bytes 136 to 199

.reg place, r15                 ; 8*y + x of a pixel, 8*(y + 1) + x of a sum
.reg t,     r14
; Numbers of 16 bits, low byte and high byte. Three of them change roles from step to step.
.reg a,  r0
.reg ah, r1
.reg b,  r2
.reg bh, r3
.reg c,  r4
.reg ch, r5
.reg d,  r6                     ; what follows the last one of this NP, held by a neighbour
.reg dh, r7
.reg e,  r8                     ; last pixel of the column
.reg eh, r9

.include "lib/cds.s"

; to := signal - reset of the pixel at place, at least 0, in 16 bits
.macro pixel to, high
        cds     to, place, t
        MOV     high, #0
.endm

; to := the sum of a column at place
.macro load to, high
        LD      to, [place + LOW]
        LD      high, [place + HIGH]
.endm

; One step of 1 2 1. Takes before + this in sum, and this, and next. Gives before + 2 * this +
; next in sum, and this + next in this, which is the sum of the next step.
.macro step sum, sumh, this, thish, next, nexth
        ADD     this, next
        ADC     thish, nexth
        ADD     sum, this
        ADC     sumh, thish
.endm

; A step down a column, at the row below.
.macro down sum, sumh, this, thish, next, nexth
        step    sum, sumh, this, thish, next, nexth
        ST      [place + LOW], sum
        ST      [place + HIGH], sumh
        ADD     place, #8
.endm

; A step along a row.
.macro along sum, sumh, this, thish, next, nexth
        step    sum, sumh, this, thish, next, nexth
        SHL     sumh, #4
        SHR     sum, #4         ; C: the highest bit that is cut off
        OR      sum, sumh
        ADC     sum, #0
        OUT     0, sum
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     place, #0

.column:
        pixel   b, bh           ; the neighbours need both ends
        ADD     place, #56
        pixel   e, eh
        SUB     place, #48
        NBR     a, e, north
        NBR     d, b, south
        MOV     ah, #0
        MOV     dh, #0
        ADD     a, b
        ADC     ah, bh
        .rept 2
          pixel c, ch
          down  a, ah, b, bh, c, ch
          pixel a, ah
          down  b, bh, c, ch, a, ah
          pixel b, bh
          down  c, ch, a, ah, b, bh
        .endr
        down    a, ah, b, bh, e, eh
        down    b, bh, e, eh, d, dh
        SUB     place, #71
        CMP     place, #8
        JANY    LO, .column

.row:   ADD     place, #7       ; the sum to the west is the neighbour's last
        load    a, ah
        NBR     a, a, west
        NBR     ah, ah, west
        SUB     place, #7
        load    b, bh
        NBR     d, b, east      ; and the one to the east is the neighbour's first
        NBR     dh, bh, east
        ADD     a, b
        ADC     ah, bh
        .rept 2
          ADD   place, #1
          load  c, ch
          along a, ah, b, bh, c, ch
          ADD   place, #1
          load  a, ah
          along b, bh, c, ch, a, ah
          ADD   place, #1
          load  b, bh
          along c, ch, a, ah, b, bh
        .endr
        ADD     place, #1
        load    c, ch
        along   a, ah, b, bh, c, ch
        along   b, bh, c, ch, d, dh
        ADD     place, #1
        CMP     place, #72
        JANY    LO, .row
        JMP     frame
