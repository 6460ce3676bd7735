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
; Geometry  up to 32 rows and columns of NPs, and 2^15 pixels
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

.include "lib/farthest_points.s"

        MOV     t, #3
        OUT     0, t
        LD      t, [CORNERS + ROW_OF]
        OUT     1, t
        LD      t, [CORNERS + COL_OF]
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

.include "lib/farthest_search.s"
