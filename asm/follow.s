; follow.s - one moving object in real video: where it is, and where it will be
;
; Pixels are means of 2 x 2. Each learns its background, one step a frame towards the picture; in
; the mask, where the two differ by THRESHOLD or more, in every second frame. Ghosts, which an
; object has left behind, go into the background. What is connected in the mask about the expected
; place is the object, and its centroid its place; an eighth of what was missed goes into the
; velocity. After eight frames without it the NP with most pixels of the mask begins a new track.
; Where the mask reaches into more than half of the NPs the camera moves, and there is no object.
;
; Outputs   valid          scalar    1 where the object is seen; else all outputs are 0
;           row            scalar    row of its centroid, whole pixels
;           col            scalar    its column
;           row_sub        scalar    the rest of the row, in 256ths of a pixel
;           col_sub        scalar    the rest of the column
;           area           scalar16  number of its pixels
;           predicted_row  scalar    row of the pixel expected AHEAD frames later
;           predicted_col  scalar    its column
; Constants THRESHOLD      1 to 255, 24 if not defined
;           AHEAD          1, 2, 4 or 8, 1 if not defined
; Geometry  2 to 28 rows and columns of NPs
; Words     504
; Cycles    12,145 to 17,051 per frame (default), 17,137 to 24,253 (conservative)
; Thesis    2.1: prediction of the path; the rest is a decision (docs/tracking.md)

; Tests     npchip test asm/follow.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden
; run: mouse  frames=../examples/clips/mouse_run.npy machine=default,conservative
; expect: golden
; expect: valid[2..] == 1
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; run: far    frames=../examples/clips/mouse_run.npy define=AHEAD=8
; expect: golden

.equ THRESHOLD, 24
.equ AHEAD,     1

.require (NP_ROWS >= 2) & (NP_ROWS <= 28), "a place and the square about it have 8 bits"
.require (NP_COLS >= 2) & (NP_COLS <= 28), "a place and the square about it have 8 bits"
.if (AHEAD != 1) & (AHEAD != 2) & (AHEAD != 4) & (AHEAD != 8)
.error "AHEAD must be 1, 2, 4 or 8"
.endif

.output valid,         0, scalar
.output row,           1, scalar
.output col,           2, scalar
.output row_sub,       3, scalar
.output col_sub,       4, scalar
.output area,          5, scalar16
.output predicted_row, 6, scalar
.output predicted_col, 7, scalar
.budget words  504 + 2 * ((AHEAD >> 1) - (AHEAD >> 3)) + (AHEAD > 1)
.budget cycles 541_400          ; a labyrinth; objects take 17,000

.equ REACH,    24               ; half the side of the square where an object lies: 16-bit sums
.equ SMALLEST, 6                ; pixels of an object
.equ COAST,    9                ; frames that a track lasts

.equ SIGNAL,     0              ; banks of the NP's memory
.equ RESET,      64
.equ CODE,       64             ; (later) of each pixel:
.equ GHOST,      128            ;   in the mask, likely a ghost
.equ OBJECT,     129            ;   in the mask
.equ BACK,       1              ;   not in the mask
.equ SOLID,      64             ; (later) rows 1 to 8 of the mask, a byte each
.equ BACKGROUND, 128
.equ VARS,       192            ; rows 1 to 8 of bits, the neighbours' next to them, and
.equ ROW_AXIS,   16             ; expected place, low and high byte, and velocity
.equ COL_AXIS,   20
.equ MEAN,       VARS + 24      ; of the background

.reg turn,    r15               ; changes its highest bit in every frame
.reg life,    r14               ; frames left to the track; 0: none; COAST + 1: it begins

.reg p,       r0                ; 8*y + x
.reg f,       r1
.reg t,       r2                ; short-lived
.reg b,       r3
.reg step,    r4
.reg k,       r5
.reg d,       r6
.reg pf,      r7                ; the pixel before: picture,
.reg pb,      r8                ; background
.reg pn,      r9                ; and code
.reg n,       r10
.reg a,       r11
.reg far,     r12

.reg slow,    r13               ; (teaching) 255 in every second frame
.reg u,       r4                ; step of the background
.reg level,   r7                ; mean of the surroundings
.reg sum,     r8
.reg SUM,     r9

.reg y,       r0                ; (rows of bits)
.reg m,       r1
.reg h,       r3
.reg v,       r4
.reg at,      r5
.reg bits,    r6
.reg any,     r6
.reg c,       r7
.reg w,       r8
.reg dst,     r9
.reg rows,    r10

.reg x,       r5                ; (numbers) the fraction of s
.reg s,       r6                ; 16 bits, s and S
.reg S,       r7
.reg value,   r3
.reg most,    r4
.reg area,    r10
.reg AREA,    r11
.reg down,    r8                ; sum of the rows,
.reg DOWN,    r9
.reg right,   r12               ; of the columns
.reg RIGHT,   r13
.reg yoff,    r5
.reg xoff,    r4
.reg rl,      r1                ; remainder
.reg RH,      r2
.reg axis,    r9
.reg last,    r8
.reg e,       r1
.reg E,       r0
.reg vl,      r3
.reg vh,      r4
.reg there,   r0

.include "lib/cds.s"

        CALL    take
        MOV     p, #63
.copy:  LD      f, [p + SIGNAL]
        ST      [p + BACKGROUND], f
        SUB     p, #1
        JANY    HS, .copy

; ---- what differs from the background

teach:  LD      n, [MEAN]       ; the NPs beside; a missing one, or 0, counts as its own
        NBR     level, n, west
        CMP     level, #0
        WHERE   EQ
          MOV   level, n
        END
        NBR     b, n, east
        CMP     b, #0
        WHERE   EQ
          MOV   b, n
        END
        ADD     level, b
        RCR     level
        ADD     turn, #128
        SBC     slow, slow
        MOV     sum, #0
        MOV     SUM, #0
        MOV     p, #63
.pixel: LD      f, [p + SIGNAL]
        LD      b, [p + BACKGROUND]
        MOV     d, f
        SUB     d, level
        CALL    absolute
        MOV     a, d
        MOV     d, b
        SUB     d, level
        CALL    absolute
        CMP     a, d            ; C: more like its surroundings than the background is
        MOV     n, #OBJECT
        SBC     n, #0           ; GHOST
        MOV     d, f
        SUB     d, b
        SBC     u, u
        CALL    absolute
        OR      u, #1           ; towards the picture,
        CMP     d, #1
        SBC     u, #0           ; or 0
        CMP     d, #THRESHOLD
        WHERE   HS
          AND   u, slow
        ELSE
          MOV   n, #BACK
        END
        ST      [p + CODE], n
        ADD     b, u
        ST      [p + BACKGROUND], b
        ADD     sum, b
        ADC     SUM, #0
        SUB     p, #1
        JANY    HS, .pixel
        .rept   2
        ADD     sum, sum
        ADC     SUM, SUM
        .endr
        ST      [MEAN], SUM

        MOV     step, #1        ; ghosts, along the rows ...
        MOV     far, #7
        MOV     p, #0
.row:   CALL    ends
        NBR     pf, pf, west
        NBR     pb, pb, west
        NBR     pn, pn, west
        CALL    peel
        CMP     p, #64
        JANY    LO, .row
        MOV     step, #8        ; ... and the columns
        MOV     far, #56
        MOV     p, #7
.col:   CALL    ends
        NBR     pf, pf, north
        NBR     pb, pb, north
        NBR     pn, pn, north
        CALL    peel
        SUB     p, #64 + 1      ; the column before
        JANY    HS, .col

        MOV     t, #0           ; the mask as bits
        MOV     pf, #1
.bits:  MOV     d, #1           ; a sentinel: falls out on the left after eight pixels
.bit:   LD      n, [t + CODE]
        ADD     t, #1
        SHL     n, #1
        ADC     d, d
        JNONE   CS, .bit
        ST      [pf + VARS], d
        ADD     pf, #1
        CMP     t, #64
        JANY    LO, .bits

        CALL    borders         ; keep pixels with a neighbour beside and one above or below
        MOV     any, #0
.solid: CALL    around
        AND     m, h
        AND     m, v
        ST      [y + SOLID], m
        OR      any, m
        SUB     y, #1
        JANY    NE, .solid
        CMP     any, #1         ; s: 64 in an NP without any
        SBC     s, s
        AND     s, #64
        MOV     S, #0
        CALL    total
        CMP     S, #NP_ROWS * NP_COLS / 8       ; S: a quarter of their number
        JANY    LO, moving

; ---- the object

        CMP     life, #0
        JANY    NE, track
        MOV     y, #(SOLID - VARS) & 0xFF
        CALL    sums            ; the NP with most pixels
        MOV     value, area
        CALL    maximum
        CMP     most, #SMALLEST
        JANY    LO, nothing
        CMP     area, most
        WHERE   NE
          MOV   area, #0        ; out
        END
        ROW     value
        CALL    choose
        ST      [VARS + ROW_AXIS + 1], most
        COL     value
        CALL    choose
        ST      [VARS + COL_AXIS + 1], most
        MOV     life, #COAST + 1

track:  MOV     w, #REACH
        MOV     dst, #SOLID + 8
        CALL    square
        SUB     w, life
        SUB     w, life
        MOV     dst, #VARS + 8
        CALL    square
        .loop   1, 4 * REACH * REACH
grow:   CALL    borders         ; from the seeds to what is connected with them
        MOV     any, #0
.row:   CALL    around
        OR      h, m
        OR      h, v
        LD      v, [y + SOLID]
        AND     h, v
        ST      [y + VARS], h
        SUB     h, m
        OR      any, h
        SUB     y, #1
        JANY    NE, .row
        CMP     any, #0
        JANY    NE, grow

        MOV     y, #0
        CALL    sums
        MOV     s, area
        MOV     S, #0
        CALL    total
        MOV     area, s
        MOV     AREA, S
        SUB     s, #SMALLEST
        SBC     S, #0
        MOV     t, #0
        RCR     t
        OR      life, t         ; 128: missed
        MOV     s, down
        MOV     S, DOWN
        MOV     axis, #ROW_AXIS
        MOV     last, #ROWS - 1
        CALL    measure
        OUT     1, s
        OUT     3, x
        OUT     6, there
        MOV     s, right
        MOV     S, RIGHT
        MOV     axis, #COL_AXIS
        MOV     last, #COLS - 1
        CALL    measure
        OUT     2, s
        OUT     4, x
        OUT     7, there
        SUB     life, #128 + 1
        JANY    HS, nothing
        MOV     life, #COAST
        MOV     t, #1
        OUT     0, t
        OUT     5, area
        OUT     5, AREA
        JMP     frame

moving: MOV     life, #0        ; the camera
nothing:
        MOV     t, #0
        .rept   8, port
        OUT     port, t
        .endr
        OUT     5, t            ; the high byte
frame:  CALL    take
        JMP     teach

; ---- pixels

; Takes a frame, and means of 2 x 2 of its pixels.
take:   EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     p, #63
.cds:   cds     f, p, t
        ST      [p + SIGNAL], f
        SUB     p, #1
        JANY    HS, .cds
        MOV     step, #1
        MOV     p, #0
.row:   LD      b, [p + SIGNAL]
        NBR     b, b, east
        ADD     p, #7
        CALL    means
        ADD     p, #9
        CMP     p, #64
        JANY    LO, .row
        MOV     step, #8
        MOV     p, #7
.col:   LD      b, [p + SIGNAL]
        NBR     b, b, south
        ADD     p, #56
        CALL    means
        ADD     p, #8 - 1       ; the column before; C: it exists
        JANY    CS, .col
        RET

; Means of eight pixels, from the last one on, with the pixel behind; b: the one behind the last
means:  MOV     k, #8
.pixel: LD      f, [p + SIGNAL]
        MOV     t, f
        ADD     f, b
        RCR     f
        ST      [p + SIGNAL], f
        MOV     b, t
        SUB     p, step
        SUB     k, #1
        JANY    NE, .pixel
        RET

; d := |d|. Takes C from the subtraction. Changes t.
absolute:
        WHERE   LO
          MOV   t, #0
          SUB   t, d
          MOV   d, t
        END
        RET

; The last pixel of a row or column of the NP
ends:   MOV     a, p
        ADD     a, far
        LD      pf, [a + SIGNAL]
        LD      pb, [a + BACKGROUND]
        LD      pn, [a + CODE]
        RET

; Takes the ghosts among eight pixels into the background.
peel:   MOV     k, #8
.pixel: LD      f, [p + SIGNAL]
        LD      b, [p + BACKGROUND]
        LD      n, [p + CODE]
        MOV     d, pb
        SUB     d, b
        CALL    absolute
        MOV     a, d
        SHR     a, #2
        MOV     d, pf
        SUB     d, f
        CALL    absolute
        MOV     t, pn
        SUB     t, n
        CMP     t, #(BACK - GHOST) & 0xFF
        WHERE   EQ
          CMP   d, a
          WHERE LO
            MOV b, f
            ST  [p + BACKGROUND], b
            MOV n, #BACK
            ST  [p + CODE], n
          END
        END
        MOV     pf, f
        MOV     pb, b
        MOV     pn, n
        ADD     p, step
        SUB     k, #1
        JANY    NE, .pixel
        RET

; ---- rows of bits

; Gets the neighbours' rows next to the NP's own. Gives y, the last row.
borders:
        LD      t, [VARS + 8]
        NBR     t, t, north
        ST      [VARS], t
        LD      t, [VARS + 1]
        NBR     t, t, south
        ST      [VARS + 9], t
        MOV     y, #8
        RET

; m := row y; h: pixels with a neighbour beside; v: with one above or below
around: LD      m, [y + VARS]
        NBR     t, m, west
        SHR     t, #1
        MOV     h, m
        RCR     h
        NBR     t, m, east
        SHL     t, #1
        MOV     t, m
        ADC     t, t
        OR      h, t
        MOV     at, y
        SUB     at, #1
        LD      v, [at + VARS]
        ADD     at, #2
        LD      t, [at + VARS]
        OR      v, t
        RET

; Rows up to dst := the mask in the square of 2*w pixels a side about the expected place
square: LD      c, [VARS + ROW_AXIS + 1]
        ROW     t
        CALL    span
        MOV     rows, bits
        LD      c, [VARS + COL_AXIS + 1]
        COL     t
        CALL    span
        MOV     y, #8
.row:   LD      m, [y + SOLID]
        AND     m, bits
        SHR     rows, #1
        SBC     t, t
        AND     m, t
        ST      [dst], m
        SUB     dst, #1
        SUB     y, #1
        JANY    NE, .row
        RET

; bits := those of eight pixels, in the NP of number t, between c - w and c + w - 1
span:   CALL    offset
        SUB     t, #1
        MOV     k, w
        ADD     k, w
        MOV     bits, #1
.bit:   ADD     t, #1
        CMP     t, k
        ADC     bits, bits
        JNONE   CS, .bit
        RET

; t := distance of the first of them from c - w
offset: SHL     t, #3
        SUB     t, c
        ADD     t, w
        RET

; ---- numbers

; Counts the NP's pixels in eight rows, the first behind y, and adds up their places in the square.
sums:   MOV     w, #REACH
        LD      c, [VARS + COL_AXIS + 1]
        COL     t
        CALL    offset
        MOV     xoff, t
        LD      c, [VARS + ROW_AXIS + 1]
        ROW     t
        CALL    offset
        MOV     yoff, t
        MOV     area, #0
        MOV     down, #0
        MOV     DOWN, #0
        MOV     right, #0
        MOV     RIGHT, #0
.row:   ADD     y, #1
        LD      m, [y + VARS]
        MOV     t, xoff
.bit:   SHL     m, #1
        WHERE   CS
          ADD   area, #1
          ADD   down, yoff
          ADC   DOWN, #0
          ADD   right, t
          ADC   RIGHT, #0
        END
        ADD     t, #1
        CMP     m, #0
        JANY    NE, .bit
        ADD     yoff, #1
        MOV     t, y
        AND     t, #7
        JANY    NE, .row
        RET

; most := 8 * value + 4 of the NPs that are left, the largest; the others are out
choose: CMP     area, #0
        WHERE   EQ
          MOV   value, #0
        END
        MOV     s, value
        CALL    maximum
        CMP     s, most
        WHERE   NE
          MOV   area, #0
        END
        SHL     most, #3
        ADD     most, #4
        RET

; S:s := its sum over all NPs
total:  MOV     k, #NP_COLS - 1
        MOV     t, s
        MOV     rl, S
.east:  NBR     t, t, west
        NBR     rl, rl, west
        ADD     s, t
        ADC     S, rl
        SUB     k, #1
        JANY    NE, .east
        MOV     k, #NP_ROWS - 1
        MOV     t, s
        MOV     rl, S
.south: NBR     t, t, north
        NBR     rl, rl, north
        ADD     s, t
        ADC     S, rl
        SUB     k, #1
        JANY    NE, .south
        MOV     value, S        ; the largest is that of the last NP
        CALL    maximum
        CMP     S, most
        MOV     S, most
        MOV     value, s
        WHERE   NE
          MOV   value, #0
        END
        CALL    maximum
        MOV     s, most
        RET

; most := the largest value of all NPs. Changes t, k and value.
maximum:
        MOV     most, #0
        MOV     k, #0x80
.bit:   SHL     value, #1
        JNONE   CS, .clear
        SBC     t, t            ; 255 where the bit is set: the others are out
        AND     value, t
        OR      most, k
.clear: SHR     k, #1
        JNONE   CS, .bit
        RET

; ---- one axis: takes s, the sum of places, and gives s:x, the place, and the one expected

measure:
        CALL    total
        MOV     x, #0           ; s:x := s / area, bit by bit
        MOV     rl, #0
        MOV     RH, #0
        MOV     E, #24
.bit:   ADD     x, x
        ADC     s, s
        ADC     S, S
        ADC     rl, rl
        ADC     RH, RH
        SUB     rl, area
        SBC     RH, AREA
        WHERE   LO
          ADD   rl, area
          ADC   RH, AREA
        ELSE
          ADD   x, #1
        END
        SUB     E, #1
        JANY    NE, .bit
        LD      t, [axis + VARS]        ; S:t: the expected place
        ADD     axis, #1
        LD      S, [axis + VARS]
        ADD     axis, #1
        LD      vl, [axis + VARS]
        ADD     axis, #1
        LD      vh, [axis + VARS]
        ADD     s, S
        SUB     s, #REACH
        CMP     life, #128
        WHERE   HS              ; missed: as expected
          MOV   x, t
          MOV   s, S
        END
        MOV     e, x            ; what the expected place has missed by
        SUB     e, t
        MOV     E, s
        SBC     E, S
        CMP     life, #COAST + 1
        WHERE   EQ
          MOV   E, #100         ; a new track
        END
        ADD     E, #4
        CMP     E, #8
        WHERE   LO
          SHR   e, #3
          SHL   E, #5
          OR    e, E            ; an eighth of it, and 128
          ADD   vl, e
          ADC   vh, #0
          SUB   vl, #128
          SBC   vh, #0
        ELSE                    ; a surprise
          MOV   vl, #0
          MOV   vh, #0
        END
        ST      [axis + VARS], vh
        SUB     axis, #1
        ST      [axis + VARS], vl
        SUB     axis, #1
        CALL    ahead
        ST      [axis + VARS], there
        SUB     axis, #1
        ST      [axis + VARS], t
        .rept   (AHEAD >> 1) - (AHEAD >> 3)
        ADD     vl, vl
        ADC     vh, vh
        .endr
        .rept   AHEAD > 1
        CALL    ahead
        .endr
        CMP     there, last     ; half a pixel back, and rounded
        ADC     there, #0
        ADD     x, #128
        ADC     s, #0
        RET

; there:t := s:x + vh:vl, or s:x where that is outside the frame
ahead:  MOV     t, x
        MOV     there, s
        ADD     t, vl
        ADC     there, vh
        CMP     last, there
        WHERE   LO
          MOV   t, x
          MOV   there, s
        END
        RET

.include "lib/threshold.s"
