; tracking_large.s - tracking.s for larger arrays: places of 16 bits, an area of 24
;
; With correlated double sampling. A bright object is every pixel of THRESHOLD or more; a dark one,
; with DARK defined as 1, every pixel below THRESHOLD. Its bounding box is found by
; lib/bounds_large.s, its area by adding over neighbours.
;
; Outputs   valid        scalar    1 where there is an object; else all outputs are 0
;           top          scalar16  first row of the bounding box
;           bottom       scalar16  its last row
;           left         scalar16  its first column
;           right        scalar16  its last column
;           center_row   scalar16  (top + bottom) >> 1
;           center_col   scalar16  (left + right) >> 1
;           area         scalar16  number of its pixels, modulo 65,536
;           area_high    scalar    and how often 65,536
; Constants THRESHOLD    1 to 255, 128 if not defined
;           DARK         0 or 1, 0 if not defined
; Words     205
; Cycles    2,107 per frame (default), 3,390 (conservative)
; Thesis    1.3: object tracking; 2.1.1: centre of an object

; Tests     npchip test asm/tracking_large.s
;
; run: levels levels=127,128,255
; expect: valid == 0, 1, 1
; expect: area == 0, 5120, 5120
; expect: center_col == 0, 39, 39
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.equ THRESHOLD, 128
.equ DARK,      0

.output valid,      0, scalar
.output top,        1, scalar16
.output bottom,     2, scalar16
.output left,       3, scalar16
.output right,      4, scalar16
.output center_row, 5, scalar16
.output center_col, 6, scalar16
.output area,       7, scalar16
.output area_high,  8, scalar
.position center_row, center_col
.budget words  205
.budget cycles 2194             ; a box of rows and columns 7 to 56: most bits

.include "lib/box_registers.s"
.include "lib/cds.s"

.reg high,  r9                  ; the last row of the box
.reg LOW,   r10                 ; high bytes
.reg HIGH,  r11
.reg area,  r12                 ; pixels of the object: in the NP, then on the way from north-west
.reg area1, r13
.reg area2, r14
.reg level, r15
.reg steps, r7                  ; (later)

; Sends the box in one axis, and its middle.
.macro send first, last, middle
        OUT     first, low
        OUT     first, LOW
        OUT     last, high
        OUT     last, HIGH
        ADD     low, high
        ADC     LOW, HIGH
        SHR     LOW, #1
        RCR     low
        OUT     middle, low
        OUT     middle, LOW
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     level, #THRESHOLD - DARK
        MOV     area, #64
        MOV     cols, #0xFF     ; columns without the object so far
        MOV     rows, #1        ; a sentinel: falls out on the left after eight rows
        MOV     pixel, #0
.row:   MOV     bits, #1        ; the same for eight pixels
.pixel: cds     f, pixel, t
        ADD     pixel, #1
        .rept 1 - DARK
        CMP     f, level        ; C: background, f < THRESHOLD
        .endr
        .rept DARK
        CMP     level, f        ; C: background, THRESHOLD - 1 < f
        .endr
        SBC     t, t            ; -1 for each pixel of the background
        ADC     bits, bits      ; collect their bits
        SBC     f, f            ; C: the sentinel; ADD would lose it
        ADD     area, t
        CMP     f, #0
        JNONE   NE, .pixel
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
        CALL    bounds
        send    1, 2, 5
        COL     base            ; ... and in the horizontal
        MOV     value, cols
        CALL    bounds
        send    3, 4, 6

        ; Numbers move to the east and south, and every NP adds up what comes by. So the last
        ; one of each row sees the whole row, and then the last one of all the whole frame.
        MOV     area1, #0
        MOV     area2, #0
.if NP_COLS > 1
        MOV     t, area
        MOV     steps, #NP_COLS - 1
.east:  NBR     t, t, west
        ADD     area, t
        ADC     area1, #0
        SUB     steps, #1
        JANY    NE, .east
.endif
.if NP_ROWS > 1
        MOV     t, area
        MOV     f, area1
        MOV     steps, #NP_ROWS - 1
.south: NBR     t, t, north
        NBR     f, f, north
        ADD     area, t
        ADC     area1, f
        ADC     area2, #0
        SUB     steps, #1
        JANY    NE, .south
.endif
        ROW     t
        CMP     t, #NP_ROWS - 1
        WHERE   EQ
          COL   t
          CMP   t, #NP_COLS - 1
          WHERE EQ
            OUT 7, area
            OUT 7, area1
            OUT 8, area2
          END
        END
        JMP     frame

nothing:
        MOV     t, #0
        OUT     0, t
        .rept 7, port
        OUT     port + 1, t
        OUT     port + 1, t
        .endr
        OUT     8, t
        JMP     frame

.include "lib/bounds_large.s"

.include "lib/threshold.s"
