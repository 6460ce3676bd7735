; keypoints_farthest.s - the three corners of a triangle as its farthest points
;
; With correlated double sampling. A bright object is every pixel of THRESHOLD or more; a dark one,
; with DARK defined as 1, every pixel below THRESHOLD. All pixels of the frame count as one object.
; A search finds the object's pixel R that is farthest from the line through the last two points P
; and Q, by the size of the cross product
;
;       (R - P) x (Q - P)  =  (row - P.row) * right - (col - P.col) * down
;
; where right and down lead from P to Q. It starts from the left edge of the frame; the last three
; of SEARCHES points are the corners. Only the first and the last pixel of a row of an NP can be
; the farthest. From one row to the next the product changes by right, along a row by multiples
; of down, which one table holds for all NPs: nothing is multiplied there.
;
; Outputs   count     scalar   3; 0 without an object
;           points    list     row and column of each corner
; Constants THRESHOLD 1 to 255, 128 if not defined
;           DARK      0 or 1, 0 if not defined
;           SEARCHES  3 to 255, 6 if not defined
; Geometry  up to 2^15 pixels, so that a product fits in 15 bits and its sign
; Words     225
; Cycles    7,359 per frame (default), 10,208 (conservative)
; Thesis    a variant of 3.3 with better figures; npchip.vision.keypoints, farthest_points

; Tests     npchip test asm/keypoints_farthest.s
;
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative define=DARK=1
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.equ THRESHOLD, 128
.equ DARK,      0
.equ SEARCHES,  6

.output count,  0, scalar
.output points, 1, list
.budget words  225
.budget cycles 7541             ; no frame of 64 x 80 can have more bits in all its numbers

.equ SIGNAL,   0                ; banks of the NP's memory
.equ RESET,    64
.equ FIRST,    0                ; (later) first object pixel in each row of the NP, 8 without ...
.equ LAST,     64               ; ... and the last one
.equ MULTIPLE, 128              ; 0 to 8 times down, low bytes ...
.equ HIGH,     192              ; ... and high bytes

.equ RIGHT,    LAST + 8         ; variables: right in 16 bits,
.equ OLDER,    LAST + 10        ; the point before P,
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
.reg before, r7                 ; 255 up to the first object pixel of a row
.reg level,  r8
.reg u,      r1                 ; (products) a byte ...
.reg w,      r5                 ; ... and 16 bits
.reg W,      r6
.reg value,  r3                 ; (maximum)
.reg bits,   r4
.reg best,   r5

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     level, #THRESHOLD - DARK
        MOV     in, #0
        MOV     pixel, #0
        MOV     y, #0
.row:   MOV     x, #0
        MOV     first, #0
        MOV     last, #8
        MOV     before, #255
.pixel: LD      f, [pixel + SIGNAL]
        LD      t, [pixel + RESET]
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

        MOV     prow, #0        ; the left edge of the frame
        MOV     pcol, #0
        MOV     qrow, #1
        MOV     qcol, #0
        MOV     t, #SEARCHES
.next:  ST      [LEFT], t
        CALL    search
        ST      [OLDER], prow
        ST      [OLDER + 1], pcol
        MOV     prow, qrow
        MOV     pcol, qcol
        MOV     qrow, row
        MOV     qcol, col
        LD      t, [LEFT]
        SUB     t, #1
        JANY    NE, .next

        MOV     t, #3
        OUT     0, t
        LD      t, [OLDER]
        OUT     1, t
        LD      t, [OLDER + 1]
        OUT     1, t
        OUT     1, prow
        OUT     1, pcol
        OUT     1, qrow
        OUT     1, qcol
        JMP     frame

nothing:
        MOV     t, #0
        OUT     0, t
        JMP     frame

; row, col := the object's pixel that is farthest from the line through P and Q; of several the
; last one in the order of the scan
search:
        MOV     w, qrow         ; multiples of down
        SUB     w, prow
        SBC     W, W
        MOV     g, #0
        MOV     G, #0
        MOV     x, #0
.times: ST      [x + MULTIPLE], g
        ST      [x + HIGH], G
        ADD     g, w
        ADC     G, W
        ADD     x, #1
        CMP     x, #8
        JANY    LO, .times
        MOV     g, #0           ; the product at the NP's first pixel: - (col - P.col) * down ...
        MOV     G, #0
        COL     t
        SHL     t, #3
        MOV     u, pcol
        SUB     u, t
        CALL    product
        MOV     w, qcol         ; ... + (row - P.row) * right
        SUB     w, pcol
        SBC     W, W
        ST      [RIGHT], w
        ST      [RIGHT + 1], W
        ROW     u
        SHL     u, #3
        SUB     u, prow
        CALL    product

        LD      in, [OBJECT]
        MOV     most, #0
        MOV     MOST, #0
        MOV     y, #0
.line:  LD      x, [y + FIRST]
        CALL    compare
        LD      x, [y + LAST]
        CALL    compare
        LD      t, [RIGHT]
        ADD     g, t
        LD      t, [RIGHT + 1]
        ADC     G, t
        ADD     y, #1
        CMP     y, #8
        JANY    LO, .line

        ROW     t               ; its place in the frame
        SHL     t, #3
        ADD     row, t
        COL     t
        SHL     t, #3
        ADD     col, t
        MOV     value, MOST     ; the largest product: high byte, low byte
        CALL    maximum
        MOV     value, most
        CALL    maximum
        MOV     value, row      ; the last row, and the last column in it
        CALL    maximum
        MOV     row, best
        MOV     value, col
        CALL    maximum
        MOV     col, best
        RET

; g:G := g:G + u * w:W. Takes u from a subtraction, C where it is negative. Changes all three.
product:
        WHERE   LO              ; both change their signs
          MOV   t, #0
          SUB   t, u
          MOV   u, t
          MOV   t, #0
          SUB   t, w
          MOV   w, t
          MOV   t, #0
          SBC   t, W
          MOV   W, t
        END
.bit:   SHR     u, #1
        WHERE   CS
          ADD   g, w
          ADC   G, W
        END
        ADD     w, w
        ADC     W, W
        CMP     u, #0
        JANY    NE, .bit
        RET

; Is pixel (y, x) at least as far as those before? x is 8 in a row without object pixels.
compare:
        LD      t, [x + MULTIPLE]
        MOV     d, g
        SUB     d, t
        LD      t, [x + HIGH]
        MOV     D, G
        SBC     D, t
        CMP     D, #0x80
        WHERE   HS              ; negative
          MOV   t, #0
          SUB   t, d
          MOV   d, t
          MOV   t, #0
          SBC   t, D
          MOV   D, t
        END
        CMP     x, #8
        WHERE   LO
          CMP   d, most
          MOV   t, D
          SBC   t, MOST
          WHERE HS
            MOV most, d
            MOV MOST, D
            MOV row, y
            MOV col, x
          END
        END
        RET

; best := the largest value of all NPs that are in; those with less are out. From the highest bit
; down, the global OR tells whether any has the bit; then those without it have lost.
maximum:
        MOV     bits, value
        AND     bits, in
        MOV     best, #0
        .rept 8, bit
          SHL   bits, #1
          JNONE CS, .clear
          SBC   t, t
          AND   bits, t
          OR    best, #0x80 >> bit
.clear:
        .endr
        CMP     value, best
        WHERE   NE
          MOV   in, #0
        END
        RET
