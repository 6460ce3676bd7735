; lib/expected.s - how far the NP lies from the square about the expected place
;
; A part of programs with track.s.

        expected_row
        ROW     t
        CALL    offset
        ST      [YOFF], t
        expected_col
        COL     t
        CALL    offset
        ST      [XOFF], t
