; median.s - 3 x 3 median: the fifth of nine pixels in order of brightness
;
; With correlated double sampling; pixels outside the frame are 0. The first pass sorts every
; column of three. Of a pixel's three sorted columns the median is the one in the middle of
;
;       the largest of the three lowest, the median of the three middle ones,
;       and the smallest of the three highest
;
; since whatever is left out has five pixels above or below it. Two neighbours share much: of the
; columns of rows y - 1 to y + 1 and y to y + 2, the pair y, y + 1 is sorted once, and along the
; rows the second pass uses pairs of columns in the same way.
;
; Output    median    picture   median of the pixel and its eight neighbours
; Words     485
; Cycles    5,699 per frame (default), 7,468 (conservative)
; Thesis    1.3: filtering

; Tests     npchip test asm/median.s
;
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.output median, 0, picture
.budget words  485
.budget cycles 5699

; The sorted columns take the place of the samples: that of row y lies where the samples of row
; y + 1 have been read by then.
.equ SIGNAL, 0
.equ RESET,  64
.equ LOW,    0                  ; bytes 8 to 71
.equ MIDDLE, 64                 ; bytes 72 to 135
.equ HIGH,   128                ; bytes 136 to 199

.reg place,  r15                ; 8*y + x of a pixel, 8*(y + 1) + x of a sorted column
.reg t,      r14

.reg above,  r0                 ; first pass: pixels of a column, from north to south
.reg upper,  r1
.reg lower,  r2
.reg below,  r3
.reg next,   r4                 ; lower, before it is sorted
.reg low,    r5
.reg middle, r6
.reg high,   r7
.reg bottom, r8                 ; last row of the column
.reg south,  r9                 ; first row of the NP to the south

.reg larger, r12                ; second pass: larger one of a pair of middle numbers
; Four columns, each its low, middle and high number. They change roles from pair to pair.
.reg al, r0
.reg am, r1
.reg ah, r2
.reg bl, r3
.reg bm, r4
.reg bh, r5
.reg cl, r6
.reg cm, r7
.reg ch, r8
.reg dl, r9
.reg dm, r10
.reg dh, r11

.include "lib/cds.s"

.macro max a, b                 ; a := the larger one
        CMP     a, b
        WHERE   LO
          MOV   a, b
        END
.endm

.macro min a, b                 ; a := the smaller one
        CMP     a, b
        WHERE   HI
          MOV   a, b
        END
.endm

.macro sort a, b                ; a <= b
        CMP     a, b
        WHERE   HI
          MOV   t, a
          MOV   a, b
          MOV   b, t
        END
.endm

.macro insert a, b, c           ; a <= b <= c, where a <= b already
        CMP     c, b
        WHERE   LO
          MOV   t, c
          MOV   c, b
          MOV   b, t
          CMP   t, a
          WHERE LO
            MOV b, a
            MOV a, t
          END
        END
.endm

.macro store a, b, c
        ST      [place + LOW], a
        ST      [place + MIDDLE], b
        ST      [place + HIGH], c
        ADD     place, #8
.endm

; Sorts the columns of two rows: above, upper, lower ...
.macro first
        MOV     next, lower
        sort    upper, lower
        MOV     low, upper
        MOV     middle, lower
        insert  low, middle, above
        store   low, middle, above
.endm

; ... and upper, lower, below
.macro second to
        MOV     high, to
        insert  upper, lower, high
        store   upper, lower, high
.endm

.macro load l, m, h
        LD      l, [place + LOW]
        LD      m, [place + MIDDLE]
        LD      h, [place + HIGH]
        ADD     place, #1
.endm

.macro fetch l, m, h, side
        NBR     l, l, side
        NBR     m, m, side
        NBR     h, h, side
.endm

; Sends the median of low, middle and high, in whatever order they are.
.macro send l, m, h
        sort    l, h
        max     m, l
        min     m, h
        OUT     0, m
.endm

; Sends a pixel from its own column p, and those to the west and east. The pair p and east is
; left in p, and in larger.
.macro even wl, wm, wh, pl, pm, ph, el, em, eh
        max     pl, el
        min     ph, eh
        MOV     larger, em
        sort    pm, larger
        max     wl, pl
        min     wh, ph
        max     wm, pm
        min     wm, larger
        send    wl, wm, wh
.endm

; Sends the pixel that follows: the pair p and the column to the east. Uses spare.
.macro odd pl, pm, ph, el, em, eh, spare
        max     pl, el
        min     ph, eh
        MOV     spare, em
        max     spare, pm
        min     spare, larger
        send    pl, spare, ph
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     place, #0

.column:
        cds     upper, place, t ; the neighbours need both ends
        ADD     place, #56
        cds     bottom, place, t
        SUB     place, #48
        NBR     above, bottom, north
        NBR     south, upper, south
.pair:  cds     lower, place, t
        first
        cds     below, place, t
        second  below
        MOV     above, next
        MOV     upper, below
        CMP     place, #56
        JANY    LO, .pair
        MOV     lower, bottom
        first
        second  south
        SUB     place, #71
        CMP     place, #8
        JANY    LO, .column

.row:   ADD     place, #7       ; the column to the west is the neighbour's last
        load    al, am, ah
        fetch   al, am, ah, west
        SUB     place, #8
        load    bl, bm, bh
        load    cl, cm, ch
        even    al, am, ah, bl, bm, bh, cl, cm, ch
        load    dl, dm, dh
        odd     bl, bm, bh, dl, dm, dh, am
        load    al, am, ah
        even    cl, cm, ch, dl, dm, dh, al, am, ah
        load    bl, bm, bh
        odd     dl, dm, dh, bl, bm, bh, cm
        load    cl, cm, ch
        even    al, am, ah, bl, bm, bh, cl, cm, ch
        load    dl, dm, dh
        odd     bl, bm, bh, dl, dm, dh, am
        load    al, am, ah
        even    cl, cm, ch, dl, dm, dh, al, am, ah
        SUB     place, #8       ; and the one to the east is the neighbour's first
        load    bl, bm, bh
        fetch   bl, bm, bh, east
        odd     dl, dm, dh, bl, bm, bh, cm
        ADD     place, #7
        CMP     place, #72
        JANY    LO, .row
        JMP     frame
