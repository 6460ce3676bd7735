; trajectory_mixed.s - one axis predicted with acceleration, the other without, until it turns back
;
; What ran on silicon: centres are found as in trajectory.s, one AXIS is predicted with equation
; 2.1, x(k) + v + 2a, the other on a straight line, and all calculation stops when the object turns
; back in AXIS. Where it moves against DIRECTION by INFLECTION or more, inflection is 1, the centre
; is repeated instead of a prediction, and the calculation starts again from this centre: so it
; stays stopped while the object moves back, and goes on when it moves forward. What is not yet
; known counts as unchanged: a first centre as at rest, a first displacement as one without
; acceleration.
;
; Outputs   valid           scalar   1 where a pixel moves; 0 in the first frame
;           center_row      scalar   row of the centre of the moving pixels' box (0 where not valid)
;           center_col      scalar   its column
;           predicted_row   scalar   row of the centre expected in the next frame (0 where not valid)
;           predicted_col   scalar   its column
;           inflection      scalar   1 where the object moves back (0 where not valid)
; Constants THRESHOLD       change of a pixel that moves, 1 to 255, 32 if not defined
;           AXIS            with acceleration: 0 rows (figure 2.5), 1 columns (figure 2.4; default)
;           DIRECTION       0: forward is down or right (default), 1: up or left
;           INFLECTION      least step back in pixels, 1 to 255, 1 if not defined
; Words     213
; Cycles    1,700 to 2,048 per frame (default), 2,736 to 3,226 (conservative)
; Thesis    2.1.4, figures 2.4 and 2.5; equations 2.1a-c

; Tests     npchip test asm/trajectory_mixed.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden
; expect: valid[5..11] == 1
; expect: valid[12..] == 0
; expect: center_col[5..11] == 76, 71, 67, 59, 54, 51, 41
; expect: inflection[6..11] == 1
; expect: predicted_col[6..11] == 71, 67, 59, 54, 51, 41
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; expect: center_row[1..] == 16..23
; run: mouse  frames=../examples/clips/mouse_run.npy
; expect: golden
; run: left   frames=../examples/clips/coin_slide.npy define=DIRECTION=1
; expect: golden
; expect: inflection == 0
; expect: predicted_col[5..11] == 76, 66, 64, 47, 52, 50, 24
; run: rows   frames=../examples/clips/coin_slide.npy define=AXIS=0
; expect: golden
; expect: predicted_row[5..8] == 25, 27, 34, 32
; expect: predicted_col[5..8] == 76, 66, 63, 51

.equ THRESHOLD,  32
.equ AXIS,       1
.equ DIRECTION,  0
.equ INFLECTION, 1

.budget words  213
.budget cycles 2072             ; a box from corner to corner takes longest

.include "lib/trajectory_common.s"

.equ CENTER,    192             ; row and column of the centre ...
.equ LAST,      194             ; ... and of the last one
.equ ALONG,     196             ; along AXIS: the last centre and this one

.output inflection,    5, scalar

.reg last,     r10
.reg turn,     r11              ; 1 where the object moves back
.reg v_low,    r12              ; displacement along AXIS, 16 bits, signed, kept
.reg v_high,   r13
.reg known,    r15              ; how many centres are known, up to 2, kept

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still

        ROW     base            ; the box in the vertical ...
        MOV     value, rows
        CALL    middle
        ST      [CENTER], center
        MOV     f, #1
        OUT     0, f
        OUT     1, center
        COL     base            ; ... and in the horizontal
        MOV     value, cols
        CALL    middle
        ST      [CENTER + 1], center
        OUT     2, center

        ; Does the object move back? Addresses, rather than jumps, tell the directions apart.
        LD      t, [LAST + AXIS]
        ST      [ALONG], t
        LD      t, [CENTER + AXIS]
        ST      [ALONG + 1], t
        LD      t, [ALONG + DIRECTION]
        LD      f, [ALONG + 1 - DIRECTION]
        CMP     known, #1
        WHERE   HS
          SUB   t, f
          WHERE HS
            CMP t, #INFLECTION
          END
        END                     ; C is clear only where all three held
        MOV     turn, #0
        WHERE   HS
          MOV   turn, #1
          MOV   known, #0
        END

        ; Along AXIS: the displacement d (t and f) and the acceleration d - v give x + d + (d - v).
        LD      center, [CENTER + AXIS]
        LD      last, [LAST + AXIS]
        CALL    displace
        CMP     known, #2
        WHERE   LO
          MOV   v_low, t
          MOV   v_high, f
        END
        MOV     value, t
        MOV     base, f
        SUB     value, v_low
        SBC     base, v_high
        MOV     v_low, t        ; d is v from now on
        MOV     v_high, f
        ADD     t, value
        ADC     f, base
        MOV     low, #AXIS * (COLS - 1) + (1 - AXIS) * (ROWS - 1)
        CALL    advance
        OUT     3 + AXIS, value

        ; Across: x + d
        LD      center, [CENTER + 1 - AXIS]
        LD      last, [LAST + 1 - AXIS]
        CALL    displace
        MOV     low, #AXIS * (ROWS - 1) + (1 - AXIS) * (COLS - 1)
        CALL    advance
        OUT     4 - AXIS, value
        CMP     known, #2
        ADC     known, #0       ; C: one more

        OUT     5, turn
        LD      t, [CENTER]
        ST      [LAST], t
        LD      t, [CENTER + 1]
        ST      [LAST + 1], t
        JMP     frame

still:  MOV     t, #0
        .rept 6, port
        OUT     port, t
        .endr
        JMP     frame

; t and f := center - last in 16 bits, 0 for a centre that is the first
displace:
        CMP     known, #1
        WHERE   LO
          MOV   last, center
        END
        MOV     t, center
        SUB     t, last
        SBC     f, f
        RET

; value := center + t and f, a displacement in 16 bits, kept between 0 and low
advance:
        MOV     value, center
        ADD     value, t
        ADC     f, #0
        CMP     f, #0x80
        inside  HS, f, t
        RET

.include "lib/moving_box.s"
.include "lib/middle.s"
