; keypoints_total.s - asm/keypoints.s with one more output and one mistake
;
; docs/debugging.md finds it. Assembled with -I asm.
;
; Outputs   objects   scalar   number of traced objects, at most 255
;           count     list     key points of each object, at most 32
;           total     scalar   key points of the frame

.equ THRESHOLD, 190
.equ DARK,      0
.equ SHORTEST,  8
.equ MERGE,     3

.output objects, 0, scalar
.output count,   1, list
.output total,   3, scalar

.include "lib/edge_tracer.s"

.equ TOTAL, BITS + 11           ; key points so far

object: MOV     t, points
        SUB     t, #NONE
        OUT     1, t
        LD      v, [TOTAL]
        ADD     v, t
        ST      [TOTAL], v
        RET

done:   LD      t, [FOUND]
        OUT     0, t
        LD      t, [TOTAL]
        OUT     3, t
        MOV     t, #0
        ST      [TOTAL], t
        RET
