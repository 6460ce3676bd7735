; lib/edge_tracer.s - finds all objects of every frame and the key points of their edges
;
; The body of a program: takes a frame, looks for objects, traces their edges, and begins again.
; The program that includes it has THRESHOLD, DARK, SHORTEST and MERGE, and two routines:
;
;       object          the key points of an object have been found: points - NONE of them, from
;                       [NONE + ROW_OF] and [NONE + COL_OF] on, each as the distance from the NP's
;                       own first pixel. May change all registers.
;       done            the frame has been searched, and FOUND objects found. May change all.
;
; A scan looks through the rows for an object that has not been traced. An edge tracer goes round
; it, from each pixel on to the left, straight on, to the right or back, and marks the pixels that
; it visits. The key points are where its steps show that a new side has begun.
;
; The tracer is a place in the frame that all NPs know, each by the distance from its own first
; pixel: y and x are both below 8 in the one NP that owns the pixel, and no NP owns a pixel outside
; the frame. The owner answers through the global OR.
;
; Geometry  up to 31 x 31 NPs
; Thesis    3.3.1 and 3.3.2; every rule is explained in npchip.vision.keypoints

.equ SIGNAL, 0                  ; banks of the NP's memory
.equ RESET,  64
.equ OBJECT, SIGNAL             ; object pixels: a byte for each row of the NP, x = 0 rightmost
.equ MARKED, RESET              ; the same for marked pixels
.equ BITS,   128                ; 1 << x, and a bit for each direction
.equ DOWN,   RESET              ; how each direction changes y ...
.equ RIGHT,  192                ; ... and x
.equ ROW_OF, BITS               ; key points NONE, NONE + 1 ...
.equ COL_OF, RIGHT

.equ NORTH,  8                  ; directions, places in BITS, DOWN and RIGHT
.equ EAST,   9
.equ SOUTH,  10
.equ WEST,   11
.equ TURN,   0b1011             ; keeps a sum of turns among them
.equ NONE,   16                 ; the key points have other places there
.equ MOST,   NONE + 32

.equ FOUND,  RIGHT + 48         ; variables: objects so far,
.equ SCAN,   RIGHT + 49         ; y of the scan,
.equ PHASE,  RIGHT + 50         ; 0 on the first step, 1 up to the first key point, then 2,
.equ HOME,   RIGHT + 51         ; y, x of the step that showed it,
.equ BEGIN,  RIGHT + 53         ; y, x where the present run began,
.equ FIRST,  RIGHT + 55         ; first complete run in the present direction; 0: none yet,
.equ OTHER,  RIGHT + 56         ; and in the other direction

.reg y,      r0                 ; place of the tracer, from the NP's first pixel
.reg x,      r1
.reg ny,     r2                 ; its next place
.reg nx,     r3
.reg turn,   r4                 ; direction of the next step ...
.reg ahead,  r5                 ; ... and of the last one
.reg t,      r6                 ; short-lived
.reg v,      r7
.reg run,    r8                 ; steps in the present direction ...
.reg limit,  r9                 ; ... and how many make a key point
.reg tries,  r10
.reg stored, r11                ; the directions of this side, as bits
.reg before, r12                ; length of the run before; 0 in the first run of a side
.reg steps,  r13                ; of the round, up to SHORTEST
.reg home,   r14                ; direction of the step that showed the first key point; 0: none
.reg points, r15                ; next free place for one

.reg ky,     r10                ; a key point
.reg kx,     r8

.reg pixel,  r1                 ; (capture) 8*y + x
.reg f,      r2
.reg bits,   r3
.reg level,  r4

.reg free,   r2                 ; (scan) pixels that are not marked
.reg fresh,  r3                 ; ... and of the object
.reg seed,   r4
.reg sum,    r5
.reg carry,  r8
.reg top,    r9

; Marks the pixel in row `row` of the NP whose bit t holds; in other NPs t is 0, and Z says so.
.macro mark row
        WHERE   NE
          LD    v, [row + MARKED]
          OR    v, t
          ST    [row + MARKED], v
        END
.endm

; t := 3 * value; 255, more than any run, where that is too much or value is 0. Changes limit.
.macro triple value
        MOV     t, value
        ADD     t, t
        ADD     t, value
        MOV     limit, value
        SUB     limit, #1
        CMP     limit, #85
        WHERE   HS
          MOV   t, #255
        END
.endm

        MOV     x, #0           ; BITS: 1, 2 ... 128, 1, 2, 4, 8
        MOV     t, #1
power:  ST      [x + BITS], t
        ADD     t, t
        ADC     t, #0
        ADD     x, #1
        CMP     x, #WEST + 1
        JANY    LO, power
        MOV     t, #1
        ST      [RIGHT + EAST], t
        MOV     t, #-1
        ST      [RIGHT + WEST], t

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     level, #THRESHOLD - DARK
        MOV     pixel, #0
        MOV     y, #0
.row:   MOV     bits, #0x80     ; a sentinel: falls out on the right after eight pixels
.pixel: LD      f, [pixel + SIGNAL]
        LD      t, [pixel + RESET]
        ADD     pixel, #1
        SUB     f, t            ; correlated double sampling
        WHERE   LO
          MOV   f, #0
        END
        .rept 1 - DARK
        CMP     f, level        ; C: background, f < THRESHOLD
        .endr
        .rept DARK
        CMP     level, f        ; C: background, THRESHOLD - 1 < f
        .endr
        RCR     bits
        JNONE   CS, .pixel
        MOV     t, #255
        SUB     t, bits
        ST      [y + OBJECT], t ; over samples that have been read
        MOV     t, #0
        ST      [y + MARKED], t
        ADD     y, #1
        CMP     y, #8
        JANY    LO, .row
        ST      [DOWN + EAST], t
        ST      [DOWN + WEST], t
        ST      [FOUND], t
        MOV     t, #1
        ST      [DOWN + SOUTH], t
        MOV     t, #-1
        ST      [DOWN + NORTH], t

        ROW     t               ; y of row 0
        SHL     t, #3
        MOV     y, #0
        SUB     y, t
scan:   CALL    look
        JANY    NE, trace
        ADD     y, #1
        CMP     y, #8
        JANY    LO, scan        ; some NP has such a row
        CALL    done
        JMP     frame

; ---- scan tracer

; Looks for the first pixel of row y that belongs to an object that has not been traced. Behind a
; marked pixel whose right neighbour is a fresh one (the seed) all pixels are ignored up to the next
; marked one: there an addition to the free pixels carries the seed through them and clears them.
; Gives x and t, its bit in its NP; Z where there is none.
look:
        LD      v, [y + MARKED]
        MOV     free, #255
        SUB     free, v
        CMP     y, #8
        SBC     t, t            ; 255 in the NPs of the row
        LD      fresh, [y + OBJECT]
        AND     fresh, free
        AND     fresh, t
        JNONE   NE, .none
        NBR     seed, fresh, east
        SHR     seed, #1
        MOV     seed, fresh
        RCR     seed            ; right neighbours
        AND     seed, v
        SHL     seed, #1
        SBC     top, top        ; a seed in the next NP
        MOV     carry, top
        .loop   NP_COLS + 1
.carry: NBR     t, carry, west
        SHR     t, #1
        MOV     sum, free
        ADC     sum, seed
        SBC     t, t
        OR      t, top
        CMP     t, carry
        MOV     carry, t
        JANY    NE, .carry      ; on to the next NP, until nothing changes
        AND     fresh, sum
        JNONE   NE, .none

        COL     t               ; x of column 0
        SHL     t, #3
        MOV     x, #0
        SUB     x, t
        .loop   NP_COLS
.np:    CMP     x, #8           ; eight columns at a time ...
        SBC     t, t
        AND     t, fresh
        JANY    NE, .pixel
        ADD     x, #8
        JMP     .np
        .loop   8
.pixel: CMP     x, #8           ; ... then one
        SBC     t, t
        AND     t, fresh
        LD      v, [x + BITS]
        AND     t, v
        JANY    NE, .none
        ADD     x, #1
        JMP     .pixel
.none:  RET

; ---- edge tracer

trace:  mark    y
        ST      [SCAN], y
        MOV     t, #0
        ST      [PHASE], t
        MOV     ahead, #EAST
        MOV     limit, #0       ; any first step shows a new side
        MOV     stored, #0b1111
        MOV     home, #0

step:   MOV     turn, ahead     ; left, straight on, right, back
        ADD     turn, #WEST - NORTH
        AND     turn, #TURN
        MOV     tries, #4
.try:   LD      ny, [turn + DOWN]
        ADD     ny, y
        LD      nx, [turn + RIGHT]
        ADD     nx, x
        MOV     t, ny
        OR      t, nx
        CMP     t, #8
        SBC     t, t            ; 255 in the owner
        LD      v, [ny + OBJECT]
        AND     t, v
        LD      v, [nx + BITS]
        AND     t, v
        JANY    NE, .on
        ADD     turn, #EAST - NORTH
        AND     turn, #TURN
        SUB     tries, #1
        JANY    NE, .try
        JMP     dropped         ; a single pixel
.on:    mark    ny

        CMP     turn, ahead
        JANY    NE, .turn
        ADD     run, #1         ; straight on
        CMP     run, limit
        JANY    LO, .check
.back:  LD      ky, [BEGIN]     ; too long or too short: the corner was where this run began
        LD      kx, [BEGIN + 1]
        JMP     .point

.turn:  LD      t, [turn + BITS]
        MOV     v, t
        SHL     t, #2
        SHR     v, #2
        OR      t, v            ; the opposite direction
        AND     t, stored
        JANY    NE, .here       ; a third direction, or a reversal
        CMP     before, #0
        JNONE   NE, .same       ; the first run may be only a part
        LD      v, [FIRST]
        CMP     v, #0
        WHERE   EQ
          ST    [FIRST], run
        END
        triple  run
        CMP     v, t
        JANY    HS, .back
.same:  LD      v, [turn + BITS]
        OR      stored, v
        MOV     before, run
        LD      t, [FIRST]
        LD      v, [OTHER]
        ST      [OTHER], t
        CALL    begin
        MOV     limit, #2       ; after a run of two or more
        CMP     before, #2
        JANY    HS, .check
        triple  v
        MOV     limit, t
        JMP     .check

.here:  MOV     ky, y
        MOV     kx, x
.point: LD      t, [PHASE]
        ADD     t, #1
        ST      [PHASE], t
        CMP     t, #2
        JANY    LO, .side       ; the first step
        JANY    HI, .record
        MOV     home, turn      ; the first key point: one round from here
        ST      [HOME], y
        ST      [HOME + 1], x
        MOV     steps, #0
        MOV     points, #NONE
        CALL    side
        JMP     .go
.record:
        MOV     t, #2
        ST      [PHASE], t
        CMP     points, #NONE
        JNONE   NE, .new
        CALL    near
        JANY    NE, .side
        CMP     points, #MOST
        JNONE   LO, .side
.new:   ST      [points + ROW_OF], ky
        ST      [points + COL_OF], kx
        ADD     points, #1
.side:  CALL    side

.check: CMP     turn, home      ; the step that showed the first key point?
        JANY    NE, .go
        LD      t, [HOME]
        CMP     t, y
        JANY    NE, .go
        LD      t, [HOME + 1]
        CMP     t, x
        JANY    EQ, .round
.go:    MOV     y, ny
        MOV     x, nx
        CMP     steps, #SHORTEST
        ADC     steps, #0
        JMP     step

.round: CMP     steps, #SHORTEST
        JANY    LO, dropped
        LD      ky, [NONE + ROW_OF]
        LD      kx, [NONE + COL_OF]
        .loop   MOST - NONE
.last:  CMP     points, #NONE + 1
        JNONE   HI, .send
        CALL    near            ; the last ones close to the first
        JNONE   NE, .send
        SUB     points, #1
        JMP     .last
.send:  LD      t, [FOUND]
        CMP     t, #255
        ADC     t, #0           ; + 1 below that
        ST      [FOUND], t
        CALL    object
dropped:
        LD      y, [SCAN]
        JMP     scan

; A new side begins with this step.
side:   LD      stored, [turn + BITS]
        MOV     before, #0
        MOV     limit, #255
        MOV     v, #0           ; no complete run
        ST      [OTHER], v

; A run begins with this step. Takes v, the first complete run in its direction.
begin:  ST      [FIRST], v
        ST      [BEGIN], y
        ST      [BEGIN + 1], x
        MOV     run, #1
        MOV     ahead, turn
        RET

; Is (ky, kx) close to the last key point? Z where not. Changes limit.
near:   MOV     v, points
        SUB     v, #1
        LD      t, [v + ROW_OF]
        SUB     t, ky
        ADD     t, #MERGE
        CMP     t, #2 * MERGE + 1
        SBC     limit, limit
        LD      t, [v + COL_OF]
        SUB     t, kx
        ADD     t, #MERGE
        CMP     t, #2 * MERGE + 1
        SBC     t, t
        AND     t, limit
        RET

.include "threshold.s"

.require NP_ROWS <= 31, "8 bits hold the distance in rows from any NP to the frame's edges"
.require NP_COLS <= 31, "8 bits hold the distance in columns from any NP to the frame's edges"
