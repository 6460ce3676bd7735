; follow_many.s - up to four moving objects in real video: where they are, and will be
;
; The mask is that of follow.s: what differs from a learnt background, without ghosts and stray
; pixels. Tracks take turns: what is connected about the expected place is the track's object, and
; leaves the mask. What is left begins a new track, one a frame, in the NP with most pixels.
;
; Outputs   count          scalar    objects seen; the lists have an entry for each of them
;           id             list      number of the track, 1, 2, ...: the same from frame to frame
;           row            list      row of its centroid, whole pixels
;           col            list      its column
;           area           list      number of its pixels, at most 255
;           predicted_row  list      row of the pixel expected AHEAD frames later
;           predicted_col  list      its column
; Constants THRESHOLD      1 to 255, 24 if not defined
;           AHEAD          1, 2, 4 or 8, 1 if not defined
; Geometry  2 to 28 rows and columns of NPs
; Words     497
; Cycles    10,922 to 18,319 per frame (default), 15,646 to 27,348 (conservative)
; Thesis    2.1: prediction of the path; the rest is a decision (docs/tracking.md)

; Tests     npchip test asm/follow_many.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden
; run: mouse  frames=../examples/clips/mouse_run.npy machine=default,conservative
; expect: golden
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; run: far    frames=../examples/clips/mouse_run.npy define=AHEAD=8
; expect: golden

.include "lib/follow_registers.s"

.require (NP_ROWS >= 2) & (NP_ROWS <= 28), "a place and the square about it have 8 bits"
.require (NP_COLS >= 2) & (NP_COLS <= 28), "a place and the square about it have 8 bits"

.output count,         0, scalar
.output id,            1, list
.output row,           2, list
.output col,           3, list
.output area,          4, list
.output predicted_row, 5, list
.output predicted_col, 6, list
.budget words  497 + 2 * ((AHEAD >> 1) - (AHEAD >> 3)) + (AHEAD > 1)
.budget cycles 546_800          ; labyrinths; objects take 23,000

.equ REACH,    12               ; half the side of the square where an object lies
.equ SEED,     4                ; half the side of the square where it is looked for

.equ WITHIN, 0                  ; (bank) the mask in the square
.equ TURN,   VARS + 10          ; its highest bit changes in every frame
.equ COUNT,  VARS + 11
.equ FREE,   VARS + 12          ; a track without an object, or 0
.equ NEWEST, VARS + 13          ; number given last
.equ YOFF,   VARS + 54          ; of the NP's first pixel from the square
.equ XOFF,   VARS + 55
.equ MEAN,   VARS + 56          ; of the background (background.s)
.equ TRACKS, 14                 ; each: expected row, column; their fractions; velocities, low
.equ SIZE,   10                 ;   and high bytes; life, number
.equ LIFE,   8
.equ BYTE,   2                  ; (track.s)
.equ NEW,    1
.equ LEAVES, 1

.reg slot,    r14               ; the track
.reg life,    r15               ; twice the frames left to it; 0: none; NEW: also a new one

.macro expected_row
        LD      c, [slot + VARS]
.endm

.macro expected_col
        MOV     c, slot
        ADD     c, #1
        LD      c, [c + VARS]
.endm

        .include "lib/background.s"
        .include "lib/solid_mask.s"
        MOV     t, #0
        ST      [COUNT], t
        ST      [FREE], t
        CMP     S, #HALF
        JANY    LO, done        ; the camera moves

; ---- the objects

        MOV     slot, #TRACKS
follow: MOV     axis, slot
        ADD     axis, #LIFE
        LD      life, [axis + VARS]
        CMP     life, #0
        JANY    NE, track
        ST      [FREE], slot
        JMP     next

track:  .include "lib/expected.s"
        MOV     w, #REACH
        MOV     dst, #WITHIN + 8
        CALL    square
        MOV     w, #SEED
        MOV     dst, #VARS + 8
        CALL    square
        .include "lib/connected.s"

        CALL    sums            ; y is 0
        MOV     s, area
        CALL    total8
        MOV     area, most
        MOV     AREA, S
        SUB     most, #SMALLEST
        SBC     S, #0
        RCR     life            ; 128: missed
        MOV     s, down
        MOV     S, DOWN
        MOV     axis, slot
        MOV     last, #ROWS - 1
        CALL    measure
        CMP     life, #128
        JANY    HS, .col
        OUT     2, s
        OUT     5, there
.col:   MOV     s, right
        MOV     S, RIGHT
        MOV     axis, slot
        ADD     axis, #1
        MOV     last, #COLS - 1
        CALL    measure
        SUB     life, #128 + 1
        JANY    HS, missed
        OUT     3, s
        OUT     6, there
        CMP     AREA, #0
        JANY    EQ, .area
        MOV     area, #255
.area:  OUT     4, area
        ADD     axis, #LIFE     ; its number
        LD      t, [axis + VARS]
        OUT     1, t
        LD      t, [COUNT]
        ADD     t, #1
        ST      [COUNT], t
        MOV     life, #COAST
missed: ADD     life, life
        MOV     t, slot
        ADD     t, #LIFE
        ST      [t + VARS], life
next:   ADD     slot, #SIZE
        CMP     slot, #TRACKS + 4 * SIZE
        JANY    LO, follow

        LD      slot, [FREE]
        CMP     slot, #0
        JANY    EQ, done
        MOV     y, #(SOLID - VARS) & 0xFF
        CALL    sums            ; the NP with most pixels that are left
        MOV     value, area
        CALL    choose
        CMP     most, #SMALLEST
        JANY    LO, done
        ROW     value
        CALL    choose
        ST      [slot + VARS], s
        ADD     slot, #1
        COL     value
        CALL    choose
        ST      [slot + VARS], s
        ADD     slot, #LIFE - 1
        MOV     t, #2 * NEW
        ST      [slot + VARS], t
        LD      t, [NEWEST]
        ADD     t, #1
        ST      [NEWEST], t
        ADD     slot, #1
        ST      [slot + VARS], t
done:   LD      t, [COUNT]
        OUT     0, t
        JMP     frame

.include "lib/foreground.s"
.include "lib/track.s"
