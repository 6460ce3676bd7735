; trajectory_mixed_large.s - trajectory_mixed.s for larger arrays: places of 16 bits
;
; Predicts one AXIS with acceleration, x(k) + v + 2a, and the other on a straight line, and starts
; again where the object moves back in AXIS: there inflection is 1 and the centre is repeated. What
; is not yet known counts as unchanged.
;
; Outputs   valid           scalar    1 where a pixel moves; 0 in the first frame
;           center_row      scalar16  row of the centre of the box (0 where not valid)
;           center_col      scalar16  its column
;           predicted_row   scalar16  row of the centre expected in the next frame (0 where not
;                                     valid)
;           predicted_col   scalar16  its column
;           inflection      scalar    1 where the object moves back (0 where not valid)
; Constants THRESHOLD       change of a pixel that moves, 1 to 255, 32 if not defined
;           AXIS            with acceleration: 0 rows, 1 columns (default)
;           DIRECTION       0: forward is down or right (default), 1: up or left
;           INFLECTION      least step back in pixels, 1 to 255, 1 if not defined
; Words     254
; Cycles    1,732 to 2,311 per frame (default), 2,800 to 3,717 (conservative)
; Thesis    2.1.4, figures 2.4 and 2.5; equations 2.1a-c

; Tests     npchip test asm/trajectory_mixed_large.s
;
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden
; expect: inflection[6..11] == 1
; expect: predicted_col[6..11] == 71, 67, 59, 54, 51, 41
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden
; expect: center_row[1..] == 16..23
; run: left   frames=../examples/clips/coin_slide.npy define=DIRECTION=1
; expect: golden
; expect: predicted_col[5..11] == 76, 66, 64, 47, 52, 50, 24

.equ THRESHOLD,  32
.equ AXIS,       1
.equ DIRECTION,  0
.equ INFLECTION, 1

.budget words  254
.budget cycles 2346             ; a box of rows and columns 7 to 56: most bits

.include "lib/trajectory_large.s"

.equ CENTERS,   192             ; row and column of the centre, low and high bytes ...
.equ LASTS,     196             ; ... and of the last one
.equ ALONG,     2 * AXIS        ; places in them
.equ ACROSS,    2 - 2 * AXIS

.output inflection,    5, scalar

.reg last,     r12
.reg LAST,     r3               ; (when rows is used up)
.reg turn,     r4               ; (when cols is used up) 1 where the object moves back
.reg v_low,    r13              ; displacement along AXIS, 16 bits, signed, kept
.reg v_high,   r14
.reg known,    r15              ; how many centres are known, up to 2, kept

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still
        MOV     t, #1
        OUT     0, t
        ROW     base
        middle_large rows
        ST      [CENTERS], center
        ST      [CENTERS + 1], CENTER
        send    1, center, CENTER
        COL     base
        middle_large cols
        ST      [CENTERS + 2], center
        ST      [CENTERS + 3], CENTER
        send    2, center, CENTER

        ; Does the object move back? Not with its first centre: a displacement of 0 is no step.
        MOV     value, #ALONG
        CALL    displace
        MOV     value, t
        MOV     base, f
.if DIRECTION
        SUB     value, #INFLECTION
        SBC     base, #0
.else
        ADD     value, #INFLECTION - 1
        ADC     base, #0
.endif
        MOV     turn, #0
        CMP     base, #0x80
.if DIRECTION
        WHERE   LO
.else
        WHERE   HS
.endif
          MOV   turn, #1
          MOV   known, #0
          MOV   t, #0
          MOV   f, #0
        END

        ; Along AXIS: the displacement d (f:t) and the acceleration d - v give x + d + (d - v).
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
        limit   AXIS * COLS + (1 - AXIS) * ROWS
        CALL    advance
        send    3 + AXIS, value, f

        ; Across: x + d
        MOV     value, #ACROSS
        CALL    displace
        limit   AXIS * ROWS + (1 - AXIS) * COLS
        CALL    advance
        send    4 - AXIS, value, f
        CMP     known, #2
        ADC     known, #0       ; C: one more

        OUT     5, turn
        .rept   4, byte
        LD      t, [CENTERS + byte]
        ST      [LASTS + byte], t
        .endr
        JMP     frame

still:  send_still
        OUT     5, t
        JMP     frame

; CENTER:center := the centre in the axis at value, and f:t what it has moved by, 0 for a first one
displace:
        LD      center, [value + CENTERS]
        MOV     base, value
        ADD     base, #LASTS - CENTERS
        LD      last, [base + CENTERS]
        ADD     value, #1
        LD      CENTER, [value + CENTERS]
        ADD     base, #1
        LD      LAST, [base + CENTERS]
        CMP     known, #1
        WHERE   LO
          MOV   last, center
          MOV   LAST, CENTER
        END
        MOV     t, center
        MOV     f, CENTER
        SUB     t, last
        SBC     f, LAST
        RET

; f:value := CENTER:center + f:t, kept between 0 and LOW:low
advance:
        MOV     value, center
        ADD     value, t
        ADC     f, CENTER
.include "lib/inside_large.s"

.include "lib/moving_box.s"
.include "lib/bounds_large.s"
