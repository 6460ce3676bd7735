; trajectory.s - where a moving object is and where it will be in the next frame
;
; A pixel moves when it differs from the frame before by THRESHOLD or more. The centre of the
; moving pixels' bounding box is the object's position; the next one is predicted on a straight
; line through the last two, 2*x(k) - x(k-1), in both axes, and kept inside the frame. Box,
; centre and prediction are computed on the array.
;
; Outputs   valid           scalar   1 where a pixel moves; 0 in the first frame
;           center_row      scalar   row of the centre of the box (0 where not valid)
;           center_col      scalar   its column
;           predicted_row   scalar   row of the centre expected in the next frame (0 where not valid)
;           predicted_col   scalar   its column
; Constant  THRESHOLD       1 to 255, 32 if not defined
; Words     174
; Cycles    1,692 to 1,997 per frame (default), 2,720 to 3,147 (conservative) on coin_slide
; Thesis    2.1.1 and 2.1.2 (linear motion), figure 2.3

; Tests     npchip test asm/trajectory.s
;
; expect: words <= 174
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: valid[5..11] == 1
; expect: valid[12..] == 0
; expect: center_col[5..11] == 76, 71, 67, 59, 54, 51, 41
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: center_row[1..] == 16..23
; expect: center_col[1..] == 36
; run: mouse  frames=../examples/clips/mouse_run.npy machine=default,conservative
; run: city   frames=../examples/clips/city_night.npy first=100 machine=default,conservative
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; run: photo  frames=../examples/clips/shapes_photo.npy machine=default,conservative
; run: faint  frames=../examples/clips/coin_slide.npy define=THRESHOLD=8
; run: flash  levels=0,0,31,63,255
; expect: valid == 0, 0, 0, 1, 1
; expect: center_row[3] == 31

.equ THRESHOLD, 32

.budget words  174
.budget cycles 2021             ; a box of nearly all pixels takes longest

.include "lib/trajectory_common.s"

.reg last,     r10
.reg row,      r11
.reg col,      r12
.reg last_row, r13              ; the last valid centre, kept from frame to frame
.reg last_col, r14
.reg known,    r15              ; 1 once there was one

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still
        centre  row, col        ; of the box of moving pixels

        CMP     known, #0       ; a first centre counts as one that has not moved
        WHERE   EQ
          MOV   last_row, row
          MOV   last_col, col
          MOV   known, #1
        END

        MOV     t, #1
        OUT     0, t
        OUT     1, row
        OUT     2, col
        MOV     center, row
        MOV     last, last_row
        MOV     low, #ROWS - 1
        CALL    predict
        OUT     3, value
        MOV     center, col
        MOV     last, last_col
        MOV     low, #COLS - 1
        CALL    predict
        OUT     4, value
        MOV     last_row, row
        MOV     last_col, col
        JMP     frame

still:  MOV     t, #0
        .rept 5, port
        OUT     port, t
        .endr
        JMP     frame

.include "lib/moving_box.s"
.include "lib/middle.s"
; value := 2 * center - last, kept between 0 and low
predict:
        MOV     t, #0           ; t:value in 16 bits
        MOV     value, center
        ADD     value, center
        ADC     t, #0
        SUB     value, last
        SBC     t, #0
        inside  LO, t, f
        RET
