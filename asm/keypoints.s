; keypoints.s - the corners of simple shapes, found by walking along their edges
;
; With correlated double sampling. A bright object is every pixel of THRESHOLD or more; a dark one,
; with DARK defined as 1, every pixel below THRESHOLD. A scan tracer looks for objects, an edge
; tracer goes round each of them and finds its key points: lib/edge_tracer.s. They are sent here.
;
; Outputs   objects   scalar   number of traced objects, at most 255
;           count     list     key points of each object, at most 32
;           points    list     row and column of each key point, object by object, clockwise
; Constants THRESHOLD 1 to 255, 128 if not defined
;           DARK      0 or 1, 0 if not defined
;           SHORTEST  steps of a trace that counts as an object, 1 to 255, 8 if not defined
;           MERGE     rows and columns within which corners are the same, 0 to 127, 3 if not defined
; Geometry  up to 31 x 31 NPs
; Words     298
; Cycles    27,825 to 31,483 per frame (default), 43,545 to 49,289 (conservative)
;           6,000 to 29,000 for a triangle, 14,000 on average (docs/keypoints.md); the smaller, the
;           fewer
; Thesis    3.3.1 and 3.3.2, figures 3.1 to 3.4

; Tests     npchip test asm/keypoints.s
;
; run: photo  frames=../examples/clips/shapes_photo.npy machine=default,conservative define=THRESHOLD=190
; expect: objects == 3, 1
; expect: count[0] == [3, 4, 4]   ; the triangle, the kite and the rectangle
; expect: count[1] == [4]
; expect: golden
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative define=DARK=1
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.equ THRESHOLD, 128
.equ DARK,      0
.equ SHORTEST,  8
.equ MERGE,     3

.output objects, 0, scalar
.output count,   1, list
.output points,  2, list
.budget words  298
.budget cycles 1087169          ; a grid of lines with holes of one pixel: 1,179 traces

.include "lib/edge_tracer.s"

; Sends the number of key points of an object and their places in the frame.
object: MOV     t, points
        SUB     t, #NONE
        OUT     1, t
        MOV     v, #NONE
        .loop   MOST - NONE
.each:  ROW     t
        SHL     t, #3
        LD      ky, [v + ROW_OF]
        ADD     ky, t
        OUT     2, ky
        COL     t
        SHL     t, #3
        LD      kx, [v + COL_OF]
        ADD     kx, t
        OUT     2, kx
        ADD     v, #1
        CMP     v, points
        JANY    LO, .each
        RET

done:   LD      t, [FOUND]
        OUT     0, t
        RET
