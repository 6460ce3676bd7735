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
.budget words  504 + 2 * ((AHEAD >> 1) - (AHEAD >> 3)) + (AHEAD > 1)
.budget cycles 541_400          ; a labyrinth; objects take 17,000

.equ SEED,     6                ; half the side of the square where it is looked for; each frame
                                ; in which it is not seen adds 2
.equ REACH,    SEED + 2 * COAST ; half the side of the square where it lies: sums have 16 bits
.equ WITHIN,   SOLID            ; the mask in the square
.equ ROW_AXIS, 16               ; expected place, high and low byte, and velocity
.equ COL_AXIS, 20
.equ MEAN,     VARS + 24        ; of the background
.equ BYTE,     1                ; (track.s)
.equ NEW,      COAST + 1
.equ LEAVES,   0

.reg turn,    r15               ; changes its highest bit in every frame
.reg life,    r14               ; frames left to the track; 0: none; COAST + 1: it begins

.reg level,   r7                ; mean of the surroundings
.reg sum,     r8                ; of the background
.reg SUM,     r9

.macro expected_row
        LD      c, [VARS + ROW_AXIS]
.endm

.macro expected_col
        LD      c, [VARS + COL_AXIS]
.endm

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

        .include "lib/solid_mask.s"
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
        ST      [VARS + ROW_AXIS], most
        COL     value
        CALL    choose
        ST      [VARS + COL_AXIS], most
        MOV     life, #NEW

track:  MOV     w, #REACH
        MOV     dst, #SOLID + 8
        CALL    square
        SUB     w, life
        SUB     w, life
        MOV     dst, #VARS + 8
        CALL    square
        .include "lib/connected.s"

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
        JANY    HS, nothing     ; missed
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

.include "lib/foreground.s"
.include "lib/track.s"
