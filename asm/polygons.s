; polygons.s - triangle, square, pentagon, octagon? The corners of convex shapes, also blunt ones
;
; With correlated double sampling. A bright object is every pixel of THRESHOLD or more that is
; connected with it by sides of pixels; a dark one, with DARK defined as 1, every pixel below. What
; lies in a hole is another object: a ring with a square in it is two. Each is taken out of the
; frame in turn, and its outline found: of two corners P and Q the next one between them is the
; pixel farthest out from the line P Q, if it is TOLERANCE or more pixels away; then every corner is
; looked at again between those beside it, LAPS times. Dents and holes do not show: a sign's
; letters do not matter. keypoints.s takes any shape, and misses blunt corners.
;
; Outputs   objects   scalar   number of objects with three corners or more, at most 255
;           count     list     corners of each object
;           regular   list     for each object 1 if its sides are about as long as each other, and
;                              its angles as wide: 4 corners are a square, 8 a STOP sign; or 0
;           points    list     row and column of each corner, object by object, clockwise
; Constants THRESHOLD 1 to 255, 128 if not defined
;           DARK      0 or 1, 0 if not defined
;           TOLERANCE 1 to 8, 2 if not defined
;           MERGE     rows and columns within which corners are one, 0 to 127, 4 if not defined
;           LAPS      1 to 8, 2 if not defined
; Geometry  up to 23 rows and columns of NPs, and 2^15 pixels
; Words     478
; Cycles    33,097 per frame (default), 46,152 (conservative)
;           14,000 to 40,000 for an object (docs/polygons.md); the more corners, the more
; Thesis    a variant of 3.3 for blunt corners and nested outlines; npchip.vision.outlines

; Tests     npchip test asm/polygons.s
;
; run: photo  frames=../examples/clips/shapes_photo.npy machine=default,conservative define=THRESHOLD=190
; expect: count[0] == [3, 4, 4]   ; the triangle, the kite and the rectangle
; expect: count[1] == [4]
; expect: regular[0] == [0, 0, 0]
; expect: golden
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative define=DARK=1
; expect: count[0] == [3]
; expect: count[1] == [4]
; expect: count[2] == [6]
; expect: regular[2] == [1]
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.equ THRESHOLD, 128
.equ DARK,      0
.equ TOLERANCE, 2
.equ MERGE,     4
.equ LAPS,      2

.output objects, 0, scalar
.output count,   1, list
.output regular, 2, list
.output points,  3, list
.budget words  472 + 2 * TOLERANCE + LAPS
.budget cycles 2997221          ; a chessboard: 2,560 objects of a pixel

.equ SIGNAL,   0                ; banks of the NP's memory
.equ RESET,    64
.equ GROWN,    0                ; rows 1 to 8 of the object, the neighbours' next to them
.equ FREE,     64               ; rows 1 to 8 of the pixels that belong to no object yet
.equ FIRST,    128              ; first pixel in each row of the object, in bytes 8 to 15; NO without
.equ LAST,     192              ; the last one
.equ MULTIPLE, 0                ; multiples of down, in bytes ZERO to NO - 1: low bytes ...
.equ HIGH,     64               ; ... and high bytes
.equ ROW_OF,   0                ; corners, in bytes NONE to TOP - 1: found ones from the beginning on,
.equ COL_OF,   64               ; those ahead from the end on
.equ ZERO,     16
.equ NO,       24
.equ NONE,     32
.equ END_OF,   64

.equ FOUND,    FIRST + 16       ; variables: objects so far,
.equ RIGHT,    FIRST + 17       ; right in 16 bits,
.equ NEXT,     FIRST + 19       ; place for the next corner,
.equ TOP,      FIRST + 20       ; place of the next one ahead,
.equ LOOK,     FIRST + 21       ; place of the next one to look at again,
.equ KEPT,     FIRST + 22       ; place for the next one that stays

.reg y,        r0
.reg x,        r1
.reg t,        r2               ; short-lived
.reg g,        r3               ; the product in column 0 of a row ...
.reg G,        r4               ; ... and its high byte
.reg d,        r5               ; the product of a pixel
.reg D,        r6
.reg most,     r7               ; the largest of the NP so far
.reg MOST,     r8
.reg row,      r9               ; its place, in the end in the frame
.reg col,      r10
.reg in,       r11              ; 255 where the farthest pixel may be
.reg prow,     r12              ; P and Q
.reg pcol,     r13
.reg qrow,     r14
.reg qcol,     r15

.reg pixel,    r3               ; (capture) 8*y + x
.reg f,        r4
.reg bits_of,  r5
.reg level,    r6

.reg zero,     r1               ; (first pixel)
.reg mask,     r7
.reg bit,      r8

.reg m,        r3               ; (growing) a row
.reg h,        r4
.reg v,        r5
.reg any,      r6               ; pixels that are new
.reg step,     r7               ; 1 on the way down, -1 on the way up
.reg first,    r4
.reg last,     r5

.reg regular,  r3               ; (sides)
.reg apart,    r4
.reg longest,  r7
.reg shortest, r8
.reg this,     r9
.reg end,      r10

.reg u,        r1               ; (products) a byte ...
.reg w,        r5               ; ... and 16 bits
.reg W,        r6
.reg value,    r3               ; (maximum)
.reg bits,     r4
.reg best,     r5

.include "lib/cds.s"

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     level, #THRESHOLD - DARK
        MOV     pixel, #0
        ST      [FOUND], pixel
        MOV     y, #1
.row:   MOV     bits_of, #1     ; a sentinel: falls out on the left after eight pixels
.pixel: cds     f, pixel, t
        ADD     pixel, #1
        .rept 1 - DARK
        CMP     f, level        ; C: background, f < THRESHOLD
        .endr
        .rept DARK
        CMP     level, f        ; C: background, THRESHOLD - 1 < f
        .endr
        ADC     bits_of, bits_of
        JNONE   CS, .pixel
        MOV     t, #255
        SUB     t, bits_of
        ST      [y + FREE], t   ; over samples that have been read
        ADD     y, #1
        CMP     y, #9
        JANY    LO, .row

; ---- the next object

next:   MOV     y, #8           ; the first row of the NP with a free pixel
        MOV     mask, #0
        MOV     zero, #0
        MOV     row, #0
.row:   ST      [y + GROWN], zero
        LD      t, [y + FREE]
        CMP     t, #0
        WHERE   NE
          MOV   row, y
          MOV   mask, t
        END
        SUB     y, #1
        JANY    NE, .row
        CMP     mask, #0
        JNONE   NE, done
        ROW     t               ; the first row of all NPs ...
        SHL     t, #3
        ADD     t, row
        MOV     value, #255
        SUB     value, t
        CMP     mask, #0
        WHERE   EQ
          MOV   value, #0
        END
        MOV     in, #255
        CALL    maximum
        MOV     prow, #254
        SUB     prow, best
        COL     t               ; ... and the first column in it
        SHL     t, #3
        MOV     value, #255
        SUB     value, t
        MOV     t, #255
        SUB     t, in
        OR      mask, t
        MOV     bit, #0x80
        .loop   8
.bit:   CMP     mask, #0x80
        JNONE   LO, .seed
        WHERE   LO
          ADD   mask, mask
          SUB   value, #1
          SHR   bit, #1
        END
        JMP     .bit
.seed:  CALL    maximum
        MOV     pcol, #255
        SUB     pcol, best
        AND     bit, in
        ST      [row + GROWN], bit

        MOV     step, #1        ; from there to all that is connected with it
        MOV     y, #1
        .loop   1, ROWS * COLS
.sweep: LD      t, [GROWN + 8]
        NBR     t, t, north
        ST      [GROWN], t
        LD      t, [GROWN + 1]
        NBR     t, t, south
        ST      [GROWN + 9], t
        MOV     any, #0
        .loop   8, 8
.line:  LD      m, [y + GROWN]
        NBR     t, m, west
        SHR     t, #1
        MOV     h, m
        RCR     h
        NBR     t, m, east
        SHL     t, #1
        MOV     t, m
        ADC     t, t
        OR      h, t
        MOV     t, y
        SUB     t, #1
        LD      v, [t + GROWN]
        OR      h, v
        ADD     t, #2
        LD      v, [t + GROWN]
        OR      h, v
        LD      v, [y + FREE]
        AND     h, v
        OR      h, m
        ST      [y + GROWN], h
        SUB     h, m
        OR      any, h
        ADD     y, step
        MOV     t, y
        SUB     t, #1
        CMP     t, #8
        JANY    LO, .line
        MOV     t, #0           ; turn round
        SUB     t, step
        MOV     step, t
        ADD     y, step
        CMP     any, #0
        JANY    NE, .sweep

        MOV     y, #8           ; its ends in each row
.ends:  LD      m, [y + GROWN]
        LD      t, [y + FREE]
        SUB     t, m
        ST      [y + FREE], t
        MOV     first, #NO
        MOV     last, #NO
        MOV     x, #NO
        .loop   1, 8
.end:   SUB     x, #1
        SHR     m, #1
        WHERE   CS
          MOV   first, x
          CMP   last, #NO
          WHERE EQ
            MOV last, x
          END
        END
        CMP     m, #0
        JANY    NE, .end
        ADD     y, #7
        ST      [y + FIRST], first
        ST      [y + LAST], last
        SUB     y, #8
        JANY    NE, .ends

; ---- its corners

        MOV     qrow, prow      ; one in the lowest row
        MOV     qcol, pcol
        ADD     pcol, #1
        CALL    search
        CMP     in, #0
        JNONE   NE, next
        MOV     pcol, qcol
        ST      [END_OF - 1 + ROW_OF], prow
        ST      [END_OF - 1 + COL_OF], pcol
        ST      [END_OF - 2 + ROW_OF], row
        ST      [END_OF - 2 + COL_OF], col
        MOV     y, #NONE
        MOV     x, #END_OF - 2
        .loop   1, 2 * (END_OF - NONE)
.ahead: ST      [NEXT], y
        ST      [TOP], x
        LD      qrow, [x + ROW_OF]
        LD      qcol, [x + COL_OF]
        CALL    search
        LD      y, [NEXT]
        LD      x, [TOP]
        CMP     in, #0
        JNONE   NE, .side
        CMP     y, x
        JNONE   LO, .side       ; no place is left
        SUB     x, #1
        ST      [x + ROW_OF], row
        ST      [x + COL_OF], col
        JMP     .ahead
.side:  MOV     prow, qrow
        MOV     pcol, qcol
        ST      [y + ROW_OF], prow
        ST      [y + COL_OF], pcol
        ADD     y, #1
        ADD     x, #1
        CMP     x, #END_OF
        JANY    LO, .ahead
        ST      [NEXT], y

        .rept   LAPS
        CALL    lap
        .endr
        LD      end, [NEXT]
        CMP     end, #NONE + 3
        JANY    LO, next        ; not an object

        MOV     regular, #1
        MOV     apart, #1
.apart: MOV     longest, #0     ; of sides, then from each corner to the one after the next
        MOV     shortest, #255
        MOV     this, #NONE
        .loop   3, END_OF - NONE
.each:  LD      prow, [this + ROW_OF]
        LD      pcol, [this + COL_OF]
        MOV     t, this
        ADD     t, apart
        CMP     t, end
        WHERE   HS
          SUB   t, end
          ADD   t, #NONE
        END
        LD      qrow, [t + ROW_OF]
        LD      qcol, [t + COL_OF]
        CALL    length
        CMP     longest, x
        WHERE   LO
          MOV   longest, x
        END
        CMP     x, shortest
        WHERE   LO
          MOV   shortest, x
        END
        ADD     this, #1
        CMP     this, end
        JANY    LO, .each
        MOV     t, longest      ; 11/16 of it
        SHR     t, #2
        SUB     longest, t
        SHR     t, #2
        SUB     longest, t
        CMP     shortest, longest
        WHERE   LO
          MOV   regular, #0
        END
        ADD     apart, #1
        CMP     apart, #3
        JANY    LO, .apart

        MOV     t, end
        SUB     t, #NONE
        OUT     1, t
        OUT     2, regular
        MOV     this, #NONE
        .loop   3, END_OF - NONE
.send:  LD      t, [this + ROW_OF]
        OUT     3, t
        LD      t, [this + COL_OF]
        OUT     3, t
        ADD     this, #1
        CMP     this, end
        JANY    LO, .send
        LD      t, [FOUND]
        CMP     t, #255
        ADC     t, #0           ; + 1 below that
        ST      [FOUND], t
        JMP     next

done:   LD      t, [FOUND]
        OUT     0, t
        JMP     frame

.include "lib/outline.s"
