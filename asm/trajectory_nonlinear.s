; trajectory_nonlinear.s - second-order prediction in both axes, with inflections and a picture
;
; Centres are found as in trajectory.s. Each axis is predicted with its latest acceleration, which
; is taken to last for STEPS frames: a step adds the acceleration to the displacement and that to
; the position, so one step is x(k) + v + 2a (equation 2.1). When the acceleration changes by
; INFLECTION or more, as where a ball hits the ground, that axis predicts nothing in this frame
; (it repeats the centre) and starts again from this centre. What is not yet known counts as
; unchanged: a first centre as at rest, a first displacement as one without acceleration.
;
; Outputs   valid           scalar   1 where a pixel moves; 0 in the first frame
;           center_row      scalar   row of the centre of the moving pixels' box (0 where not valid)
;           center_col      scalar   its column
;           predicted_row   scalar   row of the centre expected STEPS frames later (0 where not valid)
;           predicted_col   scalar   its column
;           inflection      scalar   1: in the rows, 2: in the columns, 3: in both, else 0
;           picture         picture  the frame; the predicted pixel white on dark, black on light
; Constants THRESHOLD       change of a pixel that moves, 1 to 255, 32 if not defined
;           INFLECTION      change of the acceleration in pixels, 1 to 255, 3 if not defined
;           STEPS           1 to 10, 1 if not defined; more could leave 16 bits
; Words     262
; Cycles    2,471 to 2,912 per frame (default), 4,277 to 4,873 (conservative)
; Thesis    2.1.2, equations 2.1a-c; "difficult" in both axes (2.1.4)

; Tests     npchip test asm/trajectory_nonlinear.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; expect: valid[5..11] == 1
; expect: valid[12..] == 0
; expect: center_col[5..11] == 76, 71, 67, 59, 54, 51, 41
; expect: inflection[5..11] == 0, 0, 0, 3, 0, 0, 2
; expect: predicted_col[5..11] == 76, 66, 64, 59, 49, 50, 41
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; expect: center_row[1..] == 16..23
; run: mouse  frames=../examples/clips/mouse_run.npy
; expect: golden cycles
; run: ahead  frames=../examples/clips/coin_slide.npy define=STEPS=3
; expect: golden cycles
; expect: predicted_col[5..7] == 76, 56, 61

.equ THRESHOLD,  32
.equ INFLECTION, 3
.equ STEPS,      1

.budget words  262
.budget cycles 2936             ; a box from corner to corner takes longest

.include "lib/trajectory_common.s"

.equ HISTORY,   192             ; a record for each axis:
                                ; 0 last centre, 1-2 displacement, 3-4 acceleration (low, high),
                                ; 5 how many centres are known, up to 3
.equ ROW_AXIS,  0               ; where the records begin
.equ COL_AXIS,  8

.output inflection,    5, scalar
.output picture,       6, picture

.reg count,    r6               ; (later) known centres of an axis, then steps to go
.reg axis,     r7               ; (later) place in the records
.reg row,      r10              ; the centre, then the predicted point
.reg col,      r11
.reg d_low,    r12              ; displacement, 16 bits, signed
.reg d_high,   r13
.reg a_low,    r14              ; acceleration
.reg a_high,   r15
.reg turn,     r4               ; (when cols is used up) inflections
.reg mark,     r3               ; (when rows is used up) what turn says of this axis

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
        MOV     turn, #0
        MOV     center, row
        MOV     axis, #ROW_AXIS
        MOV     mark, #1
        MOV     low, #ROWS - 1
        CALL    predict
        OUT     3, value
        MOV     row, value
        MOV     center, col
        MOV     axis, #COL_AXIS
        MOV     mark, #2
        MOV     low, #COLS - 1
        CALL    predict
        OUT     4, value
        MOV     col, value
        OUT     5, turn

        ; Draw the predicted point into the frame, send it, and put back what was there. spot is
        ; right only in the NP that has the point; elsewhere some byte is put back unchanged.
.reg spot, r10
.reg kept, r11
        ROW     t
        SHL     t, #3
        SUB     row, t          ; below 8 in the NPs of this row
        COL     t
        SHL     t, #3
        SUB     col, t
        CMP     row, #8
        WHERE   LO
          CMP   col, #8
        END                     ; the others keep the carry of the first compare: clear
        SBC     f, f            ; 255 in the NP that has the point
        SHL     row, #3
        ADD     spot, col
        LD      kept, [spot + PREVIOUS]
        CMP     f, #0
        WHERE   NE
          CMP   kept, #128
          SBC   t, t            ; 255 on dark, 0 on light
          ST    [spot + PREVIOUS], t
        END
        CALL    show
        ST      [spot + PREVIOUS], kept
        JMP     frame

still:  MOV     t, #0
        .rept 6, port
        OUT     port, t
        .endr
        CALL    show
        JMP     frame

; Sends the frame, pixel by pixel.
show:
        MOV     pixel, #0
.next:  LD      t, [pixel + PREVIOUS]
        OUT     6, t
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        RET

; Takes a centre into the record of its axis. Gives value, the predicted one, between 0 and low,
; and adds mark to turn at an inflection.
predict:
        MOV     count, axis     ; the count of known centres is the last byte of the record
        ADD     count, #5
        LD      count, [count + HISTORY]

        LD      t, [axis + HISTORY]
        ST      [axis + HISTORY], center
        CMP     count, #1
        WHERE   LO
          MOV   t, center
        END
        MOV     d_low, center   ; the new displacement ...
        SUB     d_low, t
        SBC     d_high, d_high

        ADD     axis, #1        ; ... takes the place of the old one, t and f
        LD      t, [axis + HISTORY]
        ST      [axis + HISTORY], d_low
        ADD     axis, #1
        LD      f, [axis + HISTORY]
        ST      [axis + HISTORY], d_high
        CMP     count, #2
        WHERE   LO
          MOV   t, d_low
          MOV   f, d_high
        END
        MOV     a_low, d_low    ; the new acceleration ...
        SUB     a_low, t
        MOV     a_high, d_high
        SBC     a_high, f

        ADD     axis, #1        ; ... takes the place of the old one
        LD      t, [axis + HISTORY]
        ST      [axis + HISTORY], a_low
        ADD     axis, #1
        LD      f, [axis + HISTORY]
        ST      [axis + HISTORY], a_high
        CMP     count, #3
        WHERE   LO
          MOV   t, a_low
          MOV   f, a_high
          ADD   count, #1       ; up to 3
        END

        ; Calm where -INFLECTION < change < INFLECTION, as in capture: t and f become old - new,
        ; then old - new + INFLECTION - 1, which borrows when 2 * INFLECTION - 1 is taken away.
        SUB     t, a_low
        SBC     f, a_high
        ADD     t, #INFLECTION - 1
        ADC     f, #0
        SUB     t, #(2 * INFLECTION - 1) & 0xFF
        SBC     f, #(2 * INFLECTION - 1) >> 8
        WHERE   HS
          MOV   count, #1       ; this centre is all that is known now
          MOV   d_low, #0
          MOV   d_high, #0
          MOV   a_low, #0
          MOV   a_high, #0
          OR    turn, mark
        END
        ADD     axis, #1
        ST      [axis + HISTORY], count

        MOV     value, center   ; t and value in 16 bits, signed
        MOV     t, #0
        MOV     count, #STEPS
.step:  ADD     d_low, a_low
        ADC     d_high, a_high
        ADD     value, d_low
        ADC     t, d_high
        SUB     count, #1
        JANY    NE, .step

        CMP     t, #0x80
        inside  HS, t, f
        RET

.include "lib/moving_box.s"
.include "lib/middle.s"
