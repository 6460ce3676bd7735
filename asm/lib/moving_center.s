; lib/moving_center.s - the centre of the moving pixels in both axes
;
; Stands behind moving_frame.s in a trajectory program that names the registers row and col.
; Changes what `middle` in middle.s changes.

        ROW     base            ; row and col := the middle of the box, in the vertical ...
        MOV     value, rows
        CALL    middle
        MOV     row, center
        COL     base            ; ... and in the horizontal
        MOV     value, cols
        CALL    middle
        MOV     col, center
