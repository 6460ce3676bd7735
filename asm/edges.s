; edges.s - Sobel magnitude |gx| + |gy| of every pixel, at most 255
;
; With correlated double sampling; pixels outside the frame are 0. Around a pixel e
;
;       a b c       gx = (c + 2f + i) - (a + 2d + g)      box NW = a + b + d + e  ...
;       d e f       gy = (g + 2h + i) - (a + 2b + c)
;       g h i       |gx| + |gy| = max(|gx + gy|, |gx - gy|)
;                               = 2 max(|SE - NW|, |NE - SW|)
;
; where NW, NE, SW and SE are the sums of the four 2 x 2 boxes that e is a corner of. A box is
; two pairs of pixels one above the other, and serves four pixels. So the first pass goes down
; the columns and stores pairs, the second goes along the rows and makes boxes of them. Both
; borders of an NP are fetched from its neighbours, and since the corners come as part of a
; pair, no pixel has to be sent through two NPs.
;
; Output    edges     picture   min(255, |gx| + |gy|)
; Words     449
; Cycles    4,501 per frame (default), 6,246 (conservative)
; Thesis    1.3: edge detection

; Tests     npchip test asm/edges.s
;
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.output edges, 0, picture
.budget words  449
.budget cycles 4501

; The pairs take the place of the samples. Pair 8*y + x is twice the sum of pixel (y - 1, x) and
; pixel (y, x): 72 pairs of 10 bits, stored where the samples have been read by then.
.equ SIGNAL, 0
.equ RESET,  128
.equ LOW,    0                  ; bytes 0 to 71
.equ HIGH,   128                ; bytes 128 to 199

.reg place,  r15                ; first pass: 8*y + x of a pixel or pair
.reg f,      r0                 ; two pixels, one above the other: which is which alternates
.reg g,      r1
.reg top,    r2                 ; first row of the column ...
.reg bottom, r3                 ; ... and last one
.reg south,  r4                 ; first row of the NP to the south
.reg high,   r5
.reg t,      r14

.reg n,      r15                ; second pass: 8*y + x, place of the pair (y - 1, y) ...
.reg s,      r13                ; ... and of the pair (y, y + 1)
; Three groups of two numbers: the upper pair or box, low byte n and high byte N, and the lower
; one, s and S. A group is loaded as the pairs of a column; adding the next column makes boxes of
; it, which are compared with those to the west. The groups change roles from pixel to pixel.
.reg an, r0
.reg aN, r1
.reg as, r2
.reg aS, r3
.reg bn, r4
.reg bN, r5
.reg bs, r6
.reg bS, r7
.reg cn, r8
.reg cN, r9
.reg cs, r10
.reg cS, r11

.include "lib/cds.s"

; Stores 2 * (upper + lower) at place and goes on to the next row. Changes upper.
.macro pair upper, lower
        ADD     upper, lower
        MOV     high, #0
        ADC     high, #0
        ADD     upper, upper
        ADC     high, high
        ST      [place + LOW], upper
        ST      [place + HIGH], high
        ADD     place, #8
.endm

; Loads the pairs of the next column.
.macro load un, uN, us, uS
        LD      un, [n + LOW]
        LD      uN, [n + HIGH]
        LD      us, [s + LOW]
        LD      uS, [s + HIGH]
        ADD     n, #1
        ADD     s, #1
.endm

; Makes them those of the neighbour.
.macro fetch un, uN, us, uS, side
        NBR     un, un, side
        NBR     uN, uN, side
        NBR     us, us, side
        NBR     uS, uS, side
.endm

; u := u + v: the pairs of two columns become the boxes between them.
.macro boxes un, uN, us, uS, vn, vN, vs, vS
        ADD     un, vn
        ADC     uN, vN
        ADD     us, vs
        ADC     uS, vS
.endm

; l:h := |l:h - k:m| where it is below 256; elsewhere h is not 0.
.macro distance l, h, k, m
        SUB     l, k
        SBC     h, m
        WHERE   LO              ; negative: 256 - l, if h says that no more is missing
          MOV   t, #0
          SUB   t, l
          MOV   l, t
          ADC   h, #0           ; 255 + 1, the borrow of 0 - l; anything else stays above 0
        END
.endm

; Sends a pixel from its boxes: those of u lie to the east of it, those of v to the west.
.macro edge un, uN, us, uS, vn, vN, vs, vS
        distance vn, vN, us, uS ; NW and SE
        distance vs, vS, un, uN ; SW and NE
        CMP     vn, vs
        WHERE   LO
          MOV   vn, vs
        END
        OR      vN, vS
        WHERE   NE
          MOV   vn, #255
        END
        OUT     0, vn
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     place, #0

.column:                        ; one column of all NPs, from north to south
        cds     top, place, t   ; the neighbours need both ends
        ADD     place, #56
        cds     bottom, place, t
        SUB     place, #56
        NBR     f, bottom, north
        NBR     south, top, south
        pair    f, top
        MOV     f, top
        .rept 3
          cds   g, place, t
          pair  f, g
          cds   f, place, t
          pair  g, f
        .endr
        pair    f, bottom
        pair    bottom, south
        SUB     place, #71
        CMP     place, #8
        JANY    LO, .column

        MOV     n, #0
        MOV     s, #8
.row:   ADD     n, #7           ; the column to the west is the neighbour's last
        ADD     s, #7
        load    cn, cN, cs, cS
        fetch   cn, cN, cs, cS, west
        SUB     n, #8
        SUB     s, #8
        load    an, aN, as, aS
        boxes   cn, cN, cs, cS, an, aN, as, aS
        .rept 2
          load  bn, bN, bs, bS
          boxes an, aN, as, aS, bn, bN, bs, bS
          edge  an, aN, as, aS, cn, cN, cs, cS
          load  cn, cN, cs, cS
          boxes bn, bN, bs, bS, cn, cN, cs, cS
          edge  bn, bN, bs, bS, an, aN, as, aS
          load  an, aN, as, aS
          boxes cn, cN, cs, cS, an, aN, as, aS
          edge  cn, cN, cs, cS, bn, bN, bs, bS
        .endr
        load    bn, bN, bs, bS
        boxes   an, aN, as, aS, bn, bN, bs, bS
        edge    an, aN, as, aS, cn, cN, cs, cS
        SUB     n, #8           ; the column to the east is the neighbour's first
        SUB     s, #8
        load    cn, cN, cs, cS
        fetch   cn, cN, cs, cS, east
        boxes   bn, bN, bs, bS, cn, cN, cs, cS
        edge    bn, bN, bs, bS, an, aN, as, aS
        ADD     n, #7
        ADD     s, #7
        CMP     n, #64
        JANY    LO, .row
        JMP     frame
