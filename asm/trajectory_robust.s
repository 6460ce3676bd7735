; trajectory_robust.s - prediction with acceleration that rounding does not spoil
;
; Centres are found as in trajectory.s. Equation 2.1 multiplies their rounding errors by 3, 3 and
; 1. Taken over every second centre the same parabola gives
;     (15*x(k) - 10*x(k-2) + 3*x(k-4) + 4) >> 3,
; as exact for a constant acceleration and half as sensitive. Until five centres are known the
; prediction is linear, 2*x(k) - x(k-1), and a first centre counts as at rest.
;
; Outputs   valid           scalar   1 where a pixel moves; 0 in the first frame
;           center_row      scalar   row of the centre of the moving pixels' box (0 where not valid)
;           center_col      scalar   its column
;           predicted_row   scalar   row of the centre expected in the next frame (0 where not valid)
;           predicted_col   scalar   its column
; Constant  THRESHOLD       1 to 255, 32 if not defined
; Words     218
; Cycles    1,692 to 2,091 per frame (default), 2,720 to 3,257 (conservative)
; Thesis    2.1.2 (equation 2.1); the two-frame baseline is a decision (docs/prediction.md)

; Tests     npchip test asm/trajectory_robust.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden
; expect: valid[5..11] == 1
; expect: valid[12..] == 0
; expect: center_col[5..11] == 76, 71, 67, 59, 54, 51, 41
; expect: predicted_col[5..11] == 76, 66, 63, 51, 46, 49, 35
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; expect: center_row[1..] == 16..23
; run: mouse  frames=../examples/clips/mouse_run.npy
; expect: golden

.equ THRESHOLD, 32

.budget words  218
.budget cycles 2115             ; a box from corner to corner takes longest

.include "lib/trajectory_common.s"

.equ HISTORY,   192             ; four centres of each axis, the newest first
.equ ROW_AXIS,  0               ; where they begin
.equ COL_AXIS,  4

.reg axis,     r7               ; (later) place in the history
.reg row,      r10
.reg col,      r11
.reg last,     r12              ; x(k-1)
.reg second,   r13              ; x(k-2)
.reg fourth,   r14              ; x(k-4)
.reg known,    r15              ; how many centres came before, up to 4; kept

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still
        centre  row, col        ; of the box of moving pixels

        MOV     t, #1
        OUT     0, t
        OUT     1, row
        OUT     2, col
        MOV     center, row
        MOV     axis, #ROW_AXIS
        MOV     low, #ROWS - 1
        CALL    predict
        OUT     3, value
        MOV     center, col
        MOV     axis, #COL_AXIS
        MOV     low, #COLS - 1
        CALL    predict
        OUT     4, value
        CMP     known, #4
        ADC     known, #0       ; C: one more
        JMP     frame

still:  MOV     t, #0
        .rept 5, port
        OUT     port, t
        .endr
        JMP     frame

; To and from t and value, 16 bits, signed
.macro plus x
        ADD     value, x
        ADC     t, #0
.endm
.macro minus x
        SUB     value, x
        SBC     t, #0
.endm
.macro twice
        ADD     value, value
        ADC     t, t
.endm

; Takes a centre into the history of its axis. Gives value, the predicted one, between 0 and low.
predict:
        LD      last, [axis + HISTORY]
        ST      [axis + HISTORY], center
        ADD     axis, #1
        LD      second, [axis + HISTORY]
        ST      [axis + HISTORY], last
        ADD     axis, #1
        LD      f, [axis + HISTORY]
        ST      [axis + HISTORY], second
        ADD     axis, #1
        LD      fourth, [axis + HISTORY]
        ST      [axis + HISTORY], f

        MOV     value, center
        MOV     t, #0
        CMP     known, #4
        WHERE   HS
          ; All three products together, bit by bit: 15 = 1111, -10 = -(1010), 3 = 0011
          minus second
          twice
          plus  center
          twice
          plus  center
          minus second
          plus  fourth
          twice
          plus  center
          plus  fourth
          plus  #4
          CMP   t, #0x80
          WHERE LO              ; not negative: divide by 8
            .rept 3
            SHR t, #1
            RCR value
            .endr
          END
        ELSE
          CMP   known, #1
          WHERE HS              ; on a straight line
            plus  center
            minus last
          END
        END

        CMP     t, #0x80
        inside  HS, t, f
        RET

.include "lib/moving_box.s"
.include "lib/middle.s"
