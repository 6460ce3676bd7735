; tracking.s - where a bright or a dark object is, and how large
;
; With correlated double sampling. A bright object is every pixel of THRESHOLD or more; a dark one,
; with DARK defined as 1, every pixel below THRESHOLD. Its bounding box is found with the global
; OR, its area by adding over neighbours.
;
; Outputs   valid        scalar    1 where there is an object; else all outputs are 0
;           top          scalar    first row of the bounding box
;           bottom       scalar    its last row
;           left         scalar    its first column
;           right        scalar    its last column
;           center_row   scalar    (top + bottom) >> 1
;           center_col   scalar    (left + right) >> 1
;           area         scalar16  number of its pixels
; Constants THRESHOLD    1 to 255, 128 if not defined
;           DARK         0 or 1, 0 if not defined
; Geometry  up to 32 rows and columns of NPs, 1,023 in all
; Words     281
; Cycles    1,667 per frame (default), 2,542 (conservative)
; Thesis    1.3: object tracking; 2.1.1: centre of an object

; Tests     npchip test asm/tracking.s
;
; run: levels levels=127,128,255
; expect: valid == 0, 1, 1
; expect: area == 0, 5120, 5120
; expect: center_col == 0, 39, 39
; run: dark   frames=../examples/clips/shapes_photo.npy define=DARK=1 define=THRESHOLD=64
; expect: golden
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.require NP_ROWS <= 32, "the number of a row of pixels has 8 bits"
.require NP_COLS <= 32, "the number of a column of pixels has 8 bits"
.require ROWS * COLS < 1 << 16, "an area has 16 bits"

.equ THRESHOLD, 128
.equ DARK,      0

.output valid,      0, scalar
.output top,        1, scalar
.output bottom,     2, scalar
.output left,       3, scalar
.output right,      4, scalar
.output center_row, 5, scalar
.output center_col, 6, scalar
.output area,       7, scalar16
.position center_row, center_col
.budget words  226 + 3 * (NP_COLS - 1) + 4 * (NP_ROWS - 1)
.budget cycles 1670             ; a box from the corner to row and column 63: most bits

.include "lib/box_registers.s"
.include "lib/cds.s"

.reg area,  r9                  ; pixels of the object: in the NP, then on the way from north-west
.reg areah, r10
.reg level, r11

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     level, #THRESHOLD - DARK
        MOV     area, #64
        MOV     cols, #0xFF     ; columns without the object so far
        MOV     rows, #1        ; a sentinel: falls out on the left after eight rows
        MOV     pixel, #0
.row:   .rept 8
        cds     f, pixel, t
        .rept 1 - DARK
        CMP     f, level        ; C: background, f < THRESHOLD
        .endr
        .rept DARK
        CMP     level, f        ; C: background, THRESHOLD - 1 < f
        .endr
        SBC     t, t            ; -1 for each pixel of the background
        ADC     bits, bits      ; collect their bits
        ADD     area, t
        ADD     pixel, #1
        .endr
        AND     cols, bits
        CMP     bits, #0xFF     ; lower: some pixel of this row belongs to the object
        ADC     rows, rows
        JNONE   CS, .row
        MOV     t, #0xFF
        SUB     t, cols
        MOV     cols, t

        CMP     rows, #0
        JNONE   NE, nothing
        MOV     t, #1
        OUT     0, t
        ROW     base            ; the box in the vertical ...
        MOV     value, rows
        CALL    box
        OUT     1, low
        OUT     2, most
        ADD     low, most
        RCR     low             ; (first + last) >> 1 in nine bits
        OUT     5, low
        COL     base            ; ... and in the horizontal
        MOV     value, cols
        CALL    box
        OUT     3, low
        OUT     4, most
        ADD     low, most
        RCR     low
        OUT     6, low

        ; Numbers move to the east and south, and every NP adds up what comes by. So the last
        ; one of each row sees the whole row, and then the last one of all the whole frame.
        MOV     t, area
        MOV     areah, #0
        .rept NP_COLS - 1
        NBR     t, t, west
        ADD     area, t
        ADC     areah, #0
        .endr
        MOV     t, area
        MOV     f, areah
        .rept NP_ROWS - 1
        NBR     t, t, north
        NBR     f, f, north
        ADD     area, t
        ADC     areah, f
        .endr
        ROW     t
        CMP     t, #NP_ROWS - 1
        WHERE   EQ
          COL   t
          CMP   t, #NP_COLS - 1
          WHERE EQ
            OUT 7, area
            OUT 7, areah
          END
        END
        JMP     frame

nothing:
        MOV     t, #0
        .rept 8, port
        OUT     port, t
        .endr
        OUT     7, t            ; the high byte
        JMP     frame

; The box in one axis. Takes value, the rows (or columns) of the NP with the object, and base,
; its number. Gives low, the first one of all NPs, and most, the last one, in every NP.
box:
.include "lib/bounds.s"
        ; falls through: the last row is the largest
.include "lib/maximum.s"

.include "lib/place.s"

.include "lib/threshold.s"
