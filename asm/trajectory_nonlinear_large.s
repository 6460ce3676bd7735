; trajectory_nonlinear_large.s - trajectory_nonlinear.s for larger arrays: places of 16 bits
;
; Each axis is predicted with its latest acceleration, which is taken to last for STEPS frames. When
; the acceleration changes by INFLECTION or more, that axis predicts nothing in this frame (it
; repeats the centre) and starts again from this centre. What is not yet known counts as unchanged.
;
; Outputs   valid           scalar    1 where a pixel moves; 0 in the first frame
;           center_row      scalar16  row of the centre of the box (0 where not valid)
;           center_col      scalar16  its column
;           predicted_row   scalar16  row of the centre expected STEPS frames later (0 where not
;                                     valid)
;           predicted_col   scalar16  its column
;           inflection      scalar    1: in the rows, 2: in the columns, 3: in both, else 0
;           picture         picture   the frame; the predicted pixel white on dark, black on light
; Constants THRESHOLD       change of a pixel that moves, 1 to 255, 32 if not defined
;           INFLECTION      change of the acceleration in pixels, 1 to 255, 3 if not defined
;           STEPS           1 if not defined; up to 4 on 160 NPs a side, 10 on 33
; Words     313
; Cycles    2,503 to 3,195 per frame (default), 4,341 to 5,400 (conservative)
; Thesis    2.1.2, equations 2.1a-c; "difficult" in both axes (2.1.4)

; Tests     npchip test asm/trajectory_nonlinear_large.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; expect: inflection[5..11] == 0, 0, 0, 3, 0, 0, 2
; expect: predicted_col[5..11] == 76, 66, 64, 59, 49, 50, 41
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; expect: center_row[1..] == 16..23
; run: ahead  frames=../examples/clips/coin_slide.npy define=STEPS=3
; expect: golden cycles
; expect: predicted_col[5..7] == 76, 56, 61

.equ THRESHOLD,  32
.equ INFLECTION, 3
.equ STEPS,      1

.require (STEPS + 1) * (STEPS + 1) * (ROWS - 1) < 32_768, "a place STEPS frames later has 16 bits"
.require (STEPS + 1) * (STEPS + 1) * (COLS - 1) < 32_768, "a place STEPS frames later has 16 bits"

.budget words  313
.budget cycles 3230             ; a box of rows and columns 7 to 56: most bits

.include "lib/trajectory_large.s"

.equ HISTORY,   192             ; a record for each axis:
                                ; 0-1 last centre, 2-3 displacement, 4-5 acceleration (low, high),
                                ; 6 how many centres are known, up to 3
.equ ROW_AXIS,  0               ; where the records begin
.equ COL_AXIS,  8
.equ POINT,     208             ; the predicted one: row and column, low and high bytes

.output inflection,    5, scalar
.output picture,       6, picture

.reg mark,     r3               ; (when rows is used up) what turn says of this axis
.reg turn,     r4               ; (when cols is used up) inflections
.reg count,    r6               ; (later) known centres of an axis, then steps to go
.reg axis,     r7               ; (later) place in the records
.reg d_low,    r12              ; displacement, 16 bits, signed
.reg d_high,   r13
.reg a_low,    r14              ; acceleration
.reg a_high,   r15

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still
        MOV     t, #1
        OUT     0, t
        ROW     base
        middle_large rows
        ST      [POINT], center
        ST      [POINT + 1], CENTER
        send    1, center, CENTER
        COL     base
        middle_large cols
        send    2, center, CENTER

        MOV     turn, #0
        MOV     axis, #COL_AXIS
        MOV     mark, #2
        limit   COLS
        CALL    predict
        send    4, value, f
        ST      [POINT + 2], value
        ST      [POINT + 3], f
        LD      center, [POINT]
        LD      CENTER, [POINT + 1]
        MOV     axis, #ROW_AXIS
        MOV     mark, #1
        limit   ROWS
        CALL    predict
        send    3, value, f
        ST      [POINT], value
        ST      [POINT + 1], f
        OUT     5, turn

        ; Draw the predicted point into the frame, send it, and put back what was there. spot is
        ; right only in the NP that has the point; elsewhere some byte is put back unchanged.
.reg spot, r10
.reg kept, r11
.reg has,  r12                  ; 1 in the NP that has the point
        MOV     axis, #POINT - HISTORY
        ROW     value
        CALL    pixel_of
        MOV     spot, t
        SHL     spot, #3
        MOV     has, f
        COL     value
        CALL    pixel_of
        ADD     spot, t
        AND     has, f
        LD      kept, [spot + PREVIOUS]
        WHERE   NE
          CMP   kept, #128
          SBC   t, t            ; 255 on dark, 0 on light
          ST    [spot + PREVIOUS], t
        END
        CALL    show
        ST      [spot + PREVIOUS], kept
        JMP     frame

still:  send_still
        OUT     5, t
        CALL    show
        JMP     frame

; t := the place at axis in an NP, as its row (or column) there; f: 1 where value is the NP's number.
; Leaves axis at the next place. Changes count.
pixel_of:
        LD      t, [axis + HISTORY]
        ADD     axis, #1
        LD      f, [axis + HISTORY]
        ADD     axis, #1
        MOV     count, t
        SHR     count, #3
        SHL     f, #5
        OR      count, f
        MOV     f, #0
        CMP     count, value
        WHERE   EQ
          MOV   f, #1
        END
        AND     t, #7
        RET

; Sends the frame, pixel by pixel.
show:
        MOV     pixel, #0
.next:  LD      t, [pixel + PREVIOUS]
        OUT     6, t
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        RET

; Takes a centre into the record of its axis. Gives f:value, the predicted one, between 0 and
; LOW:low, and adds mark to turn at an inflection.
predict:
        MOV     count, axis     ; the count of known centres is the last byte of the record
        ADD     count, #6
        LD      count, [count + HISTORY]

        LD      t, [axis + HISTORY]
        ST      [axis + HISTORY], center
        ADD     axis, #1
        LD      f, [axis + HISTORY]
        ST      [axis + HISTORY], CENTER
        CMP     count, #1
        WHERE   LO
          MOV   t, center
          MOV   f, CENTER
        END
        MOV     d_low, center   ; the new displacement ...
        MOV     d_high, CENTER
        SUB     d_low, t
        SBC     d_high, f

        ADD     axis, #1        ; ... takes the place of the old one, f:t
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

        ; Calm where -INFLECTION < change < INFLECTION: f:t becomes old - new, then
        ; old - new + INFLECTION - 1, which borrows when 2 * INFLECTION - 1 is taken away.
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

        MOV     value, center   ; f:value in 16 bits, signed
        MOV     f, CENTER
        MOV     count, #STEPS
.step:  ADD     d_low, a_low
        ADC     d_high, a_high
        ADD     value, d_low
        ADC     f, d_high
        SUB     count, #1
        JANY    NE, .step
.include "lib/inside_large.s"

.include "lib/moving_box.s"
.include "lib/bounds_large.s"
