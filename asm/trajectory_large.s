; trajectory_large.s - trajectory.s for larger arrays: places of 16 bits
;
; Computes what trajectory.s does: the centre of the box of the pixels that move, and the next one
; on a straight line through the last two, kept inside the frame. The number of a row is that of
; its NP's row and its own in the NP: lib/bounds_large.s.
;
; Outputs   valid           scalar    1 where a pixel moves; 0 in the first frame
;           center_row      scalar16  row of the centre of the box (0 where not valid)
;           center_col      scalar16  its column
;           predicted_row   scalar16  row of the centre expected in the next frame (0 where not
;                                     valid)
;           predicted_col   scalar16  its column
; Constant  THRESHOLD       1 to 255, 32 if not defined
; Words     213
; Cycles    1,724 to 2,249 per frame (default), 2,784 to 3,631 (conservative)
; Thesis    2.1.1 and 2.1.2 (linear motion)

; Tests     npchip test asm/trajectory_large.s
;
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: valid[5..11] == 1
; expect: valid[12..] == 0
; expect: center_col[5..11] == 76, 71, 67, 59, 54, 51, 41
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: center_row[1..] == 16..23
; expect: center_col[1..] == 36

.equ THRESHOLD, 32

.budget words  213
.budget cycles 2284             ; a box of rows and columns 7 to 56: most bits

.include "lib/trajectory_large.s"

.equ LAST_ROW, 192              ; the last valid centre, low and high bytes
.equ LAST_COL, 194

.reg last,     r12              ; the centre before, in one axis
.reg LAST,     r13
.reg known,    r15              ; 1 once there was one

; Sends the centre in one axis of so many pixels, and the next one, kept among them.
.macro predicted at, pixels, port, ahead
        LD      last, [at]
        LD      LAST, [at + 1]
        CMP     known, #0       ; a first centre counts as one that has not moved
        WHERE   EQ
          MOV   last, center
          MOV   LAST, CENTER
        END
        ST      [at], center
        ST      [at + 1], CENTER
        send    port, center, CENTER
        limit   pixels
        CALL    predict
        send    ahead, value, f
.endm

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still
        MOV     t, #1
        OUT     0, t
        ROW     base
        middle_large rows
        predicted LAST_ROW, ROWS, 1, 3
        COL     base
        middle_large cols
        predicted LAST_COL, COLS, 2, 4
        MOV     known, #1
        JMP     frame

still:  send_still
        JMP     frame

; f:value := 2 * CENTER:center - LAST:last, kept between 0 and LOW:low
predict:
        MOV     value, center
        MOV     f, CENTER
        ADD     value, center
        ADC     f, CENTER
        SUB     value, last
        SBC     f, LAST
.include "lib/inside_large.s"

.include "lib/moving_box.s"
.include "lib/bounds_large.s"
