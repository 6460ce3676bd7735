; lib/solid_mask.s - from the code of each pixel to rows of the mask, in SOLID
;
; A part of programs with foreground.s and track.s. Ghosts go into the background, stray pixels out
; of the mask. S: the number of NPs without a pixel of it, times CELL / 256.

        MOV     step, #1        ; ghosts, along the rows ...
        MOV     far, #7
        MOV     p, #0
.row:   CALL    ends
        NBR     pf, pf, west
        NBR     pb, pb, west
        NBR     pn, pn, west
        CALL    peel
        CMP     p, #64
        JANY    LO, .row
        MOV     step, #8        ; ... and the columns
        MOV     far, #56
        MOV     p, #7
.col:   CALL    ends
        NBR     pf, pf, north
        NBR     pb, pb, north
        NBR     pn, pn, north
        CALL    peel
        SUB     p, #64 + 1      ; the column before
        JANY    HS, .col

.bits:  ADD     k, #1           ; the mask as bits; p was before its first pixel, k 0
        MOV     d, #1           ; a sentinel: falls out on the left after eight pixels
.bit:   ADD     p, #1
        LD      n, [p + CODE]
        SHL     n, #1
        ADC     d, d
        JNONE   CS, .bit
        ST      [k + VARS], d
        CMP     p, #63
        JANY    LO, .bits

        CALL    borders         ; keep pixels with a neighbour beside and one above or below
        MOV     any, #0
.solid: CALL    around
        AND     m, h
        AND     m, v
        ST      [y + SOLID], m
        OR      any, m
        SUB     y, #1
        JANY    NE, .solid
        CMP     any, #1         ; s: CELL in an NP without any
        SBC     s, s
        AND     s, #CELL
        CALL    total8
