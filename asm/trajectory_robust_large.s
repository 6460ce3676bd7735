; trajectory_robust_large.s - trajectory_robust.s for larger arrays: places of 16 bits
;
; Predicts the next centre from every second of the last five:
;     (15*x(k) - 10*x(k-2) + 3*x(k-4) + 4) >> 3
; Until five centres are known the prediction is linear, 2*x(k) - x(k-1), and a first centre counts
; as at rest.
;
; Outputs   valid           scalar    1 where a pixel moves; 0 in the first frame
;           center_row      scalar16  row of the centre of the box (0 where not valid)
;           center_col      scalar16  its column
;           predicted_row   scalar16  row of the centre expected in the next frame (0 where not
;                                     valid)
;           predicted_col   scalar16  its column
; Constant  THRESHOLD       1 to 255, 32 if not defined
; Geometry  up to 227 rows and columns of NPs
; Words     260
; Cycles    1,724 to 2,358 per frame (default), 2,784 to 3,764 (conservative)
; Thesis    2.1.2 (equation 2.1); the two-frame baseline is a decision (docs/prediction.md)

; Tests     npchip test asm/trajectory_robust_large.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden
; expect: predicted_col[5..11] == 76, 66, 63, 51, 46, 49, 35
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; expect: center_row[1..] == 16..23

.equ THRESHOLD, 32

.require NP_ROWS <= 227, "15 times the number of a row of pixels, and 3 times another, have 15 bits"
.require NP_COLS <= 227, "15 times the number of a column of pixels, and 3 times another, have 15 bits"

.budget words  260
.budget cycles 2393             ; a box of rows and columns 7 to 56: most bits

.include "lib/trajectory_large.s"

.equ HISTORY,   192             ; four centres of each axis, the newest first, low and high bytes
.equ ROW_AXIS,  0               ; where they begin
.equ COL_AXIS,  8

.reg axis,     r7               ; (later) place in the history
.reg last,     r12              ; x(k-1)
.reg LAST,     r13
.reg second,   r14              ; x(k-2)
.reg SECOND,   r0
.reg fourth,   r6               ; x(k-4)
.reg FOURTH,   r3
.reg known,    r15              ; how many centres came before, up to 4; kept

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still
        MOV     t, #1
        OUT     0, t
        ROW     base
        middle_large rows
        send    1, center, CENTER
        MOV     axis, #ROW_AXIS
        limit   ROWS
        CALL    predict
        send    3, value, f
        COL     base
        middle_large cols
        send    2, center, CENTER
        MOV     axis, #COL_AXIS
        limit   COLS
        CALL    predict
        send    4, value, f
        CMP     known, #4
        ADC     known, #0       ; C: one more
        JMP     frame

still:  send_still
        JMP     frame

; To and from f:value, 16 bits, signed
.macro plus x, X
        ADD     value, x
        ADC     f, X
.endm
.macro minus x, X
        SUB     value, x
        SBC     f, X
.endm
.macro twice
        plus    value, f
.endm

; old := a centre of the history, which new replaces
.macro shift old, OLD, new, NEW
        LD      old, [axis + HISTORY]
        ST      [axis + HISTORY], new
        ADD     axis, #1
        LD      OLD, [axis + HISTORY]
        ST      [axis + HISTORY], NEW
        ADD     axis, #1
.endm

; Takes a centre into the history of its axis. Gives f:value, the predicted one, between 0 and
; LOW:low.
predict:
        shift   last, LAST, center, CENTER
        shift   second, SECOND, last, LAST
        shift   value, f, second, SECOND
        shift   fourth, FOURTH, value, f

        MOV     value, center
        MOV     f, CENTER
        CMP     known, #4
        WHERE   HS
          ; All three products together, bit by bit: 15 = 1111, -10 = -(1010), 3 = 0011
          minus second, SECOND
          twice
          plus  center, CENTER
          twice
          plus  center, CENTER
          minus second, SECOND
          plus  fourth, FOURTH
          twice
          plus  center, CENTER
          plus  fourth, FOURTH
          plus  #4, #0
          CMP   f, #0x80
          WHERE LO              ; not negative: divide by 8
            .rept 3
            SHR f, #1
            RCR value
            .endr
          END
        ELSE
          CMP   known, #1
          WHERE HS              ; on a straight line
            plus  center, CENTER
            minus last, LAST
          END
        END
.include "lib/inside_large.s"

.include "lib/moving_box.s"
.include "lib/bounds_large.s"
