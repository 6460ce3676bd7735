; lib/outline.s - the routines of polygons.s
;
;       lap             looks at every corner of the outline again
;       search          the object's pixel that is farthest out from a line
;       length          of a line

; Each corner becomes the farthest pixel from the line between those beside it, or is dropped.
lap:    LD      y, [NEXT]
        SUB     y, #1
        LD      prow, [y + ROW_OF]
        LD      pcol, [y + COL_OF]
        MOV     y, #NONE
        ST      [KEPT], y
        MOV     x, #NONE
        .loop   1, END_OF - NONE
.each:  LD      d, [x + ROW_OF]
        LD      D, [x + COL_OF]
        ADD     x, #1
        ST      [LOOK], x
        LD      t, [NEXT]
        CMP     x, t
        WHERE   EQ
          MOV   x, #NONE        ; behind the last corner comes the first
        END
        LD      qrow, [x + ROW_OF]
        LD      qcol, [x + COL_OF]
        SUB     d, qrow
        ADD     d, #MERGE
        CMP     d, #2 * MERGE + 1
        SBC     d, d
        SUB     D, qcol
        ADD     D, #MERGE
        CMP     D, #2 * MERGE + 1
        SBC     D, D
        AND     d, D
        JANY    NE, .skip       ; close to the next one
        CALL    search
        CMP     in, #0
        JNONE   NE, .skip
        LD      y, [KEPT]
        MOV     prow, row
        MOV     pcol, col
        ST      [y + ROW_OF], row
        ST      [y + COL_OF], col
        ADD     y, #1
        ST      [KEPT], y
.skip:  LD      x, [LOOK]
        LD      t, [NEXT]
        CMP     x, t
        JANY    LO, .each
        LD      y, [KEPT]
        ST      [NEXT], y
        RET

; row, col := the object's pixel that is farthest out from the line P Q, TOLERANCE or more from it;
; of several the last one in the order of the scan. in: 0 in all NPs without such a pixel
search:
        MOV     w, qrow         ; down
        SUB     w, prow
        SBC     W, W
        MOV     y, #LAST + 8    ; on the way up only the first pixel of a row can be the farthest,
        MOV     t, W            ; else only the last
        AND     t, #LAST - FIRST
        SUB     y, t
        MOV     g, #0           ; multiples of down
        MOV     G, #0
        MOV     x, #ZERO
.times: ST      [x + MULTIPLE], g
        ST      [x + HIGH], G
        ADD     g, w
        ADC     G, W
        ADD     x, #1
        CMP     x, #NO
        JANY    LO, .times
        MOV     g, #0           ; the product at the NP's first pixel: (col - P.col) * down ...
        MOV     G, #0
        COL     u
        SHL     u, #3
        SUB     u, pcol
        CALL    product
        MOV     w, qcol         ; ... - (row - P.row) * right
        SUB     w, pcol
        SBC     W, W
        ST      [RIGHT], w
        ST      [RIGHT + 1], W
        ROW     t
        SHL     t, #3
        MOV     u, prow
        SUB     u, t
        CALL    product

        CALL    length
        MOV     most, #0        ; 0x8000 higher than they are: signed numbers in order
        MOV     MOST, #0x80
        ADD     G, #0x80
        .rept   TOLERANCE
        ADD     most, x
        ADC     MOST, #0
        .endr
        MOV     in, #0
        .loop   8, 8
.line:  LD      x, [y]
        LD      t, [x + MULTIPLE]
        MOV     d, g
        ADD     d, t
        LD      t, [x + HIGH]
        MOV     D, G
        ADC     D, t
        CMP     x, #NO
        WHERE   LO
          CMP   d, most
          MOV   t, D
          SBC   t, MOST
          WHERE HS
            MOV most, d
            MOV MOST, D
            MOV row, y
            MOV col, x
            MOV in, #255
          END
        END
        LD      t, [RIGHT]
        SUB     g, t
        LD      t, [RIGHT + 1]
        SBC     G, t
        ADD     y, #1
        MOV     t, y
        AND     t, #7
        JANY    NE, .line
        AND     row, #7
        AND     col, #7
        CMP     in, #0
        JANY    NE, locate
        RET

.include "farthest_place.s"

; x := length of the line P Q: max(y, y - y/8 + x/2) over y rows and x columns, or the other way
; round with y the larger number. Changes t, d and D.
length:
        MOV     t, qrow
        SUB     t, prow
        CALL    absolute
        MOV     x, t
        MOV     t, qcol
        SUB     t, pcol
        CALL    absolute
        CMP     x, t
        WHERE   LO
          MOV   d, x
          MOV   x, t
          MOV   t, d
        END
        MOV     d, x
        SHR     d, #3
        MOV     D, x
        SUB     D, d
        SHR     t, #1
        ADD     D, t
        CMP     x, D
        WHERE   LO
          MOV   x, D
        END
        RET

; t := |t|. Takes C from the subtraction. Changes d.
absolute:
        WHERE   LO
          MOV   d, #0
          SUB   d, t
          MOV   t, d
        END
        RET

.include "threshold.s"

.if (TOLERANCE < 1) | (TOLERANCE > 8)
.error "TOLERANCE must be 1 to 8"
.endif
.if (LAPS < 1) | (LAPS > 8)
.error "LAPS must be 1 to 8"
.endif
.if (MERGE < 0) | (MERGE > 127)
.error "MERGE must be 0 to 127"
.endif

.require NP_ROWS <= 23, "the length of a line has 8 bits"
.require NP_COLS <= 23, "the length of a line has 8 bits"
.require ROWS * COLS <= 1 << 15, "a product of two distances has 15 bits and a sign"
