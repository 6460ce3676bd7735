.if NP_ROWS > 4
.error "the sum of two row numbers needs 9 bits: at most 4 rows of NPs"
.endif
        HALT
