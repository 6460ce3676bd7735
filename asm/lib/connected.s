; lib/connected.s - from the seeds, rows of bits, to the pixels in WITHIN that are connected with them
;
; A part of programs with foreground.s.

        .loop   1, 4 * REACH * REACH
grow:   CALL    borders         ; from the seeds to what is connected with them
        MOV     any, #0
.row:   CALL    around
        OR      h, m
        OR      h, v
        LD      v, [y + WITHIN]
        AND     h, v
        ST      [y + VARS], h
        SUB     h, m
        OR      any, h
        SUB     y, #1
        JANY    NE, .row
        CMP     any, #0
        JANY    NE, grow
