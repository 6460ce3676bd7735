; lib/trajectory_common.s - memory, registers and outputs of the trajectory programs
;
; Included before a program's own outputs, which go on at port 5, and registers, from r10. The
; routines of these programs, `capture` and `middle`, are in moving_box.s and middle.s.
;
; Thesis    2.1

.include "box_registers.s"

.equ PREVIOUS, 128              ; the frame before

.output valid,         0, scalar
.output center_row,    1, scalar
.output center_col,    2, scalar
.output predicted_row, 3, scalar
.output predicted_col, 4, scalar
.position center_row, center_col
.position predicted_row, predicted_col, 1

; row, col := the centre of the box of moving pixels. Changes what `middle` changes.
.macro centre row, col
        ROW     base            ; the box in the vertical ...
        MOV     value, rows
        CALL    middle
        MOV     row, center
        COL     base            ; ... and in the horizontal
        MOV     value, cols
        CALL    middle
        MOV     col, center
.endm

; value := high:value, 16 bits, kept between 0 and low. It is negative where the condition holds.
; Changes high and spare.
.macro inside negative, high, spare
        WHERE   negative
          MOV   value, #0
          MOV   high, #0
        END
        CMP     low, value
        MOV     spare, #0
        SBC     spare, high
        WHERE   LO              ; beyond the edge
          MOV   value, low
        END
.endm

.require NP_ROWS <= 32, "the number of a row of pixels has 8 bits"
.require NP_COLS <= 32, "the number of a column of pixels has 8 bits"
