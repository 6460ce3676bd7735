; lib/farthest_points.s - the three corners of a triangle as its farthest points
;
; The beginning of a program: takes a frame, finds which pixels belong to the object, and makes the
; searches. It goes on behind the file with the corners: A in [CORNERS + ROW_OF], [CORNERS + COL_OF],
; B in prow, pcol and C in qrow, qcol; without an object it goes to the label `nothing`. The
; routines are in lib/farthest_search.s. The program that includes both has THRESHOLD, DARK and
; SEARCHES, and may have BRIGHTEST as the first of two bytes for the place of the brightest pixel,
; the last one of equals.
;
; Geometry  up to 32 rows and columns of NPs, and 2^15 pixels
; Thesis    a variant of 3.3 with better figures; npchip.vision.keypoints, farthest_points

.equ SIGNAL,   0                ; banks of the NP's memory
.equ RESET,    64
.equ FIRST,    0                ; (later) first object pixel in each row of the NP, 8 without ...
.equ LAST,     64               ; ... and the last one
.equ MULTIPLE, 128              ; 0 to 8 times down, low bytes ...
.equ HIGH,     192              ; ... and high bytes

.equ RIGHT,    LAST + 8         ; variables: right in 16 bits,
.equ CORNERS,  16               ; the point before P, in [CORNERS + ROW_OF], [CORNERS + COL_OF]
.equ ROW_OF,   LAST
.equ COL_OF,   MULTIPLE
.equ LEFT,     LAST + 12        ; how many searches are left,
.equ OBJECT,   LAST + 13        ; 255 in an NP with object pixels

.reg y,      r0                 ; row and column of a pixel in its NP
.reg x,      r1
.reg t,      r2                 ; short-lived
.reg g,      r3                 ; the product in column 0 of a row ...
.reg G,      r4                 ; ... and its high byte
.reg d,      r5                 ; the product of a pixel, then its size
.reg D,      r6
.reg most,   r7                 ; the largest of the NP so far
.reg MOST,   r8
.reg row,    r9                 ; its place, in the end in the frame
.reg col,    r10
.reg in,     r11                ; 255 where the farthest pixel may be
.reg prow,   r12                ; P and Q
.reg pcol,   r13
.reg qrow,   r14
.reg qcol,   r15

.reg pixel,  r3                 ; (capture) 8*y + x
.reg f,      r4
.reg first,  r5
.reg last,   r6
.reg before, r12                ; 255 up to the first object pixel of a row
.reg level,  r13
.reg bright, r7                 ; the brightest pixel of the NP so far ...
.reg place,  r9                 ; ... as 8*y + x
.reg u,      r1                 ; (products) a byte ...
.reg w,      r5                 ; ... and 16 bits
.reg W,      r6
.reg value,  r3                 ; (maximum)
.reg bits,   r4
.reg best,   r5

.include "cds.s"

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     level, #THRESHOLD - DARK
        MOV     in, #0
.ifdef BRIGHTEST
        MOV     bright, #0
.endif
        MOV     pixel, #0
        MOV     y, #0
.row:   MOV     x, #0
        MOV     first, #0
        MOV     last, #8
        MOV     before, #255
.pixel: cds     f, pixel, t
        .ifdef BRIGHTEST
        CMP     f, bright
        WHERE   HS
          MOV   bright, f
          MOV   place, pixel
        END
        .endif
        .rept 1 - DARK
        CMP     f, level        ; C: background, f < THRESHOLD
        .endr
        .rept DARK
        CMP     level, f        ; C: background, THRESHOLD - 1 < f
        .endr
        WHERE   HS
          MOV   last, x
          MOV   in, #255
        END
        SBC     t, t
        AND     before, t
        SUB     first, before   ; + 1 for each pixel before the first
        ADD     pixel, #1
        ADD     x, #1
        CMP     x, #8
        JANY    LO, .pixel
        ST      [y + FIRST], first ; over samples that have been read
        ST      [y + LAST], last
        ADD     y, #1
        CMP     y, #8
        JANY    LO, .row
        CMP     in, #0
        JNONE   NE, nothing
        ST      [OBJECT], in
.ifdef BRIGHTEST
        MOV     in, #255
        MOV     MOST, #0
        MOV     col, place
        AND     col, #7
        SHR     row, #3
        CALL    locate
        ST      [BRIGHTEST], row
        ST      [BRIGHTEST + 1], col
.endif

        MOV     prow, #0        ; the left edge of the frame
        MOV     pcol, #0
        MOV     qrow, #1
        MOV     qcol, #0
        MOV     t, #SEARCHES
        .loop   SEARCHES, SEARCHES
.next:  ST      [LEFT], t
        CALL    search
        ST      [CORNERS + ROW_OF], prow
        ST      [CORNERS + COL_OF], pcol
        MOV     prow, qrow
        MOV     pcol, qcol
        MOV     qrow, row
        MOV     qcol, col
        LD      t, [LEFT]
        SUB     t, #1
        JANY    NE, .next

.include "threshold.s"

.require NP_ROWS <= 32, "the number of a row of pixels has 8 bits"
.require NP_COLS <= 32, "the number of a column of pixels has 8 bits"
.require ROWS * COLS <= 1 << 15, "a product of two distances has 15 bits and a sign"
