; lib/threshold.s - refuses a THRESHOLD that would be met by every pixel or by none
;
; Included by what compares bytes with THRESHOLD.

.if (THRESHOLD < 1) | (THRESHOLD > 255)
.error "THRESHOLD must be 1 to 255"
.endif
