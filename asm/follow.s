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
; Words     464
; Cycles    11,737 to 15,437 per frame (default), 17,059 to 22,428 (conservative)
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

.include "lib/follow_registers.s"

.require (NP_ROWS >= 2) & (NP_ROWS <= 28), "a place and the square about it have 8 bits"
.require (NP_COLS >= 2) & (NP_COLS <= 28), "a place and the square about it have 8 bits"

.output valid,         0, scalar
.output row,           1, scalar
.output col,           2, scalar
.output row_sub,       3, scalar
.output col_sub,       4, scalar
.output area,          5, scalar16
.output predicted_row, 6, scalar
.output predicted_col, 7, scalar
.budget words  464 + 2 * ((AHEAD >> 1) - (AHEAD >> 3)) + (AHEAD > 1)
.budget cycles 539_500          ; a labyrinth; objects take 18,000

.equ SEED,     6                ; half the side of the square where it is looked for; each frame
                                ; in which it is not seen adds 2
.equ REACH,    SEED + 2 * COAST ; half the side of the square where it lies: sums have 16 bits
.equ WITHIN,   SOLID            ; the mask in the square
.equ ROW_AXIS, 16               ; expected place, high and low byte, and velocity
.equ COL_AXIS, 20
.equ YOFF,     VARS + 10        ; of the NP's first pixel from the square
.equ XOFF,     VARS + 11
.equ MEAN,     VARS + 24        ; of the background (background.s)
.equ BYTE,     1                ; (track.s)
.equ NEW,      COAST + 1
.equ LEAVES,   0

.reg turn,    r15               ; changes its highest bit in every frame
.reg life,    r14               ; twice the frames left to the track; 0: none; NEW: it begins

.macro expected_row
        LD      c, [VARS + ROW_AXIS]
.endm

.macro expected_col
        LD      c, [VARS + COL_AXIS]
.endm

        .include "lib/background.s"
        .include "lib/solid_mask.s"
        CMP     S, #HALF
        JANY    LO, none        ; the camera moves

; ---- the object

        CMP     life, #0
        JANY    NE, track
        MOV     y, #(SOLID - VARS) & 0xFF
        CALL    sums            ; the NP with most pixels
        MOV     value, area
        CALL    choose
        CMP     most, #SMALLEST
        JANY    LO, none
        ROW     value
        CALL    choose
        ST      [VARS + ROW_AXIS], s
        COL     value
        CALL    choose
        ST      [VARS + COL_AXIS], s
        MOV     life, #2 * NEW

track:  .include "lib/expected.s"
        MOV     w, #REACH
        MOV     dst, #SOLID + 8
        CALL    square
        SUB     w, life         ; twice the frames
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
missed: RCR     life            ; 128 and more: missed
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
        AND     area, t         ; 0 where it is missed
        AND     AREA, t
        OUT     5, area
        OUT     5, AREA
        AND     t, #1
        OUT     0, t
        SHL     life, #1
        JANY    CS, .next
        MOV     life, #2 * COAST + 2
.next:  SUB     life, #2
        JMP     frame

none:   MOV     life, #2        ; with C: no object, and no track
        JMP     missed

.include "lib/foreground.s"
.include "lib/track.s"
