; follow_large.s - follow.s for larger arrays: places of 16 bits
;
; Follows one object as follow.s does, on arrays where a place does not fit into 8 bits.
;
; Outputs   valid          scalar    1 where the object is seen; else all outputs are 0
;           row            scalar16  row of its centroid, whole pixels
;           col            scalar16  its column
;           row_sub        scalar    the rest of the row, in 256ths of a pixel
;           col_sub        scalar    the rest of the column
;           area           scalar16  number of its pixels
;           predicted_row  scalar16  row of the pixel expected AHEAD frames later
;           predicted_col  scalar16  its column
; Constants THRESHOLD      1 to 255, 24 if not defined
;           AHEAD          1, 2, 4 or 8, 1 if not defined
; Geometry  2 to 256 rows and columns of NPs, fewer than 65,536 NPs
; Words     505
; Cycles    11,811 to 15,527 per frame (default), 17,173 to 22,560 (conservative)
; Thesis    2.1: prediction of the path; the rest is a decision (docs/tracking.md)

; Tests     npchip test asm/follow_large.s
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

.equ WIDE, 1

.include "lib/follow_registers.s"

.require NP_ROWS >= 2, "sums over all NPs need a neighbour"
.require NP_COLS >= 2, "sums over all NPs need a neighbour"
.require NP_ROWS * NP_COLS < 65_536, "16 bits count the NPs"

.output valid,         0, scalar
.output row,           1, scalar16
.output col,           2, scalar16
.output row_sub,       3, scalar
.output col_sub,       4, scalar
.output area,          5, scalar16
.output predicted_row, 6, scalar16
.output predicted_col, 7, scalar16
.budget words  505 + 2 * ((AHEAD >> 1) - (AHEAD >> 3)) + (AHEAD > 1)
.budget cycles 539_600          ; a labyrinth; objects take 15,000

.equ SEED,     6                ; half the side of the square where it is looked for; each frame
                                ; in which it is not seen adds 2
.equ REACH,    SEED + 2 * COAST ; half the side of the square where it lies: sums have 16 bits
.equ WITHIN,   SOLID            ; the mask in the square
.equ YOFF,     VARS + 10        ; of the NP's first pixel from the square
.equ XOFF,     VARS + 11
.equ SUM_COL,  VARS + 12        ; of the columns, low and high byte
.equ MEAN,     VARS + 26        ; of the background (background.s)
.equ ROW_AXIS, 16               ; expected place, from its high byte, and velocity
.equ COL_AXIS, 21
.equ BYTE,     1                ; (track.s)
.equ NEW,      COAST + 1
.equ LEAVES,   0

.reg turn,    r15               ; changes its highest bit in every frame
.reg life,    r14               ; twice the frames left to the track; 0: none; NEW: it begins

.macro expected_row
        LD      C, [VARS + ROW_AXIS]
        LD      c, [VARS + ROW_AXIS + 1]
.endm

.macro expected_col
        LD      C, [VARS + COL_AXIS]
        LD      c, [VARS + COL_AXIS + 1]
.endm

        .include "lib/background.s"
        .include "lib/solid_mask.s"
        CMP     S, #HALF
        JANY    LO, none        ; the camera moves

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
        ST      [VARS + ROW_AXIS], S
        ST      [VARS + ROW_AXIS + 1], s
        COL     value
        CALL    choose
        ST      [VARS + COL_AXIS], S
        ST      [VARS + COL_AXIS + 1], s
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
        ST      [SUM_COL], right
        ST      [SUM_COL + 1], RIGHT
        MOV     s, down
        MOV     S, DOWN
        MOV     axis, #ROW_AXIS
        MOV     last, #(ROWS - 1) & 0xFF
        MOV     LAST, #(ROWS - 1) >> 8
        CALL    measure
        OUT     1, s
        OUT     1, S
        OUT     3, x
        OUT     6, there
        OUT     6, THERE
        LD      s, [SUM_COL]
        LD      S, [SUM_COL + 1]
        MOV     axis, #COL_AXIS
        MOV     last, #(COLS - 1) & 0xFF
        MOV     LAST, #(COLS - 1) >> 8
        CALL    measure
        OUT     2, s
        OUT     2, S
        OUT     4, x
        OUT     7, there
        OUT     7, THERE
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
