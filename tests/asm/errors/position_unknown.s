.output center_row, 0, scalar
.output center_col, 1, plane
.position center_row, centre_col
.position center_row, center_col
        OUT     0, r0
        OUT     1, r0
        HALT
