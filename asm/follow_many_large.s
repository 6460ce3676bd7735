; follow_many_large.s - follow_many.s for larger arrays: places of 16 bits
;
; Follows up to four objects as follow_many.s does. The means of 2 x 2 pixels had to go: their words
; are those of the wider places. So it bears less noise (docs/tracking.md). SMOOTH=1 brings them back
; on a machine with 1,024 words, as a study.
;
; Outputs   count               scalar  objects seen; the lists have an entry for each of them
;           id                  list    number of the track, 1, 2, ...: the same from frame to frame
;           row                 list    row of its centroid, rounded: low byte
;           col                 list    its column
;           area                list    number of its pixels, at most 255
;           predicted_row       list    row of the pixel expected AHEAD frames later: low byte
;           predicted_col       list    its column
;           row_high            list    high byte of the row
;           col_high            list    high byte of the column
;           predicted_row_high  list    high byte of the predicted row
;           predicted_col_high  list    high byte of the predicted column
; Constants THRESHOLD           1 to 255, 24 if not defined
;           AHEAD               1, 2, 4 or 8, 1 if not defined
; Geometry  2 to 256 rows and columns of NPs, fewer than 65,536 NPs
; Words     505
; Cycles    9,559 to 17,093 per frame (default), 13,275 to 25,203 (conservative)
; Thesis    2.1: prediction of the path; the rest is a decision (docs/tracking.md)

; Tests     npchip test asm/follow_many_large.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden
; run: mouse  frames=../examples/clips/mouse_run.npy machine=default,conservative
; expect: golden
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; run: far    frames=../examples/clips/mouse_run.npy define=AHEAD=8
; expect: golden

.equ WIDE,   1
.equ SMOOTH, 0

.include "lib/follow_registers.s"

.require NP_ROWS >= 2, "sums over all NPs need a neighbour"
.require NP_COLS >= 2, "sums over all NPs need a neighbour"
.require NP_ROWS * NP_COLS < 65_536, "16 bits count the NPs"

.output count,              0, scalar
.output id,                 1, list
.output row,                2, list
.output col,                3, list
.output area,               4, list
.output predicted_row,      5, list
.output predicted_col,      6, list
.output row_high,           7, list
.output col_high,           8, list
.output predicted_row_high, 9, list
.output predicted_col_high, 10, list
.budget words  505 + 33 * SMOOTH + 2 * ((AHEAD >> 1) - (AHEAD >> 3)) + (AHEAD > 1)
.budget cycles 545_800          ; labyrinths; objects take 23,000

.equ REACH,    12               ; half the side of the square where an object lies
.equ SEED,     4                ; half the side of the square where it is looked for

.equ WITHIN, 0                  ; (bank) the mask in the square
.equ TURN,   VARS + 10          ; its highest bit changes in every frame
.equ COUNT,  VARS + 11
.equ FREE,   VARS + 12          ; a track without an object, or 0
.equ NEWEST, VARS + 13          ; number given last
.equ YOFF,    10                 ; (bank) of the NP's first pixel from the square
.equ XOFF,    11
.equ SUM_COL, 12                ; (bank) of the columns, low and high byte
.equ TRACKS, 14                 ; each: life; expected row, column, high bytes; low bytes; fractions;
.equ SIZE,   12                 ;   velocities, low and high bytes; number
.equ MEAN,   VARS + 62          ; of the background (background.s)
.equ BYTE,   2                  ; (track.s)
.equ NEW,    1
.equ LEAVES, 1

.reg slot,    r14               ; the track
.reg life,    r15               ; twice the frames left to it; 0: none; NEW: also a new one

.macro expected_row             ; slot goes on to the row
        ADD     slot, #1
        LD      C, [slot + VARS]
        ADD     slot, #2
        LD      c, [slot + VARS]
.endm

.macro expected_col             ; after expected_row
        SUB     slot, #1
        LD      C, [slot + VARS]
        ADD     slot, #2
        LD      c, [slot + VARS]
        SUB     slot, #3
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
follow: LD      life, [slot + VARS]
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
        ST      [SUM_COL], right
        ST      [SUM_COL + 1], RIGHT
        MOV     s, down
        MOV     S, DOWN
        MOV     axis, slot
        MOV     last, #(ROWS - 2 + SMOOTH) & 0xFF
        MOV     LAST, #(ROWS - 2 + SMOOTH) >> 8
        CALL    measure
        CMP     life, #128
        JANY    HS, .col
        OUT     2, s
        OUT     7, S
        OUT     5, there
        OUT     9, THERE
.col:   LD      s, [SUM_COL]
        LD      S, [SUM_COL + 1]
        MOV     axis, slot
        ADD     axis, #1
        MOV     last, #(COLS - 2 + SMOOTH) & 0xFF
        MOV     LAST, #(COLS - 2 + SMOOTH) >> 8
        CALL    measure
        SUB     life, #128 + 1
        JANY    HS, missed
        OUT     3, s
        OUT     8, S
        OUT     6, there
        OUT     10, THERE
        CMP     AREA, #0
        JANY    EQ, .area
        MOV     area, #255
.area:  OUT     4, area
        ADD     axis, #SIZE - 3 ; its number
        LD      t, [axis + VARS]
        OUT     1, t
        LD      t, [COUNT]
        ADD     t, #1
        ST      [COUNT], t
        MOV     life, #COAST
missed: ADD     life, life
        SUB     slot, #1
        ST      [slot + VARS], life
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
        MOV     t, #2 * NEW
        ST      [slot + VARS], t
        ADD     slot, #1
        ROW     value
        CALL    choose
        ST      [slot + VARS], S
        ADD     slot, #2
        ST      [slot + VARS], s
        SUB     slot, #1
        COL     value
        CALL    choose
        ST      [slot + VARS], S
        ADD     slot, #2
        ST      [slot + VARS], s
        LD      t, [NEWEST]
        ADD     t, #1
        ST      [NEWEST], t
        ADD     slot, #SIZE - 1 - 4
        ST      [slot + VARS], t
done:   LD      t, [COUNT]
        OUT     0, t
        JMP     frame

.include "lib/foreground.s"
.include "lib/track.s"
