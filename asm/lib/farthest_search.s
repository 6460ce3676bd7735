; lib/farthest_search.s - the routines of lib/farthest_points.s
;
;       search          the object's pixel that is farthest from a line

; row, col := the object's pixel that is farthest from the line through P and Q; of several the
; last one in the order of the scan
search:
        MOV     w, qrow         ; multiples of down
        SUB     w, prow
        SBC     W, W
        MOV     g, #0
        MOV     G, #0
        MOV     x, #0
.times: ST      [x + MULTIPLE], g
        ST      [x + HIGH], G
        ADD     g, w
        ADC     G, W
        ADD     x, #1
        CMP     x, #8
        JANY    LO, .times
        MOV     g, #0           ; the product at the NP's first pixel: - (col - P.col) * down ...
        MOV     G, #0
        COL     t
        SHL     t, #3
        MOV     u, pcol
        SUB     u, t
        CALL    product
        MOV     w, qcol         ; ... + (row - P.row) * right
        SUB     w, pcol
        SBC     W, W
        ST      [RIGHT], w
        ST      [RIGHT + 1], W
        ROW     u
        SHL     u, #3
        SUB     u, prow
        CALL    product

        LD      in, [OBJECT]
        MOV     most, #0
        MOV     MOST, #0
        MOV     y, #0
.line:  LD      x, [y + FIRST]
        CALL    compare
        LD      x, [y + LAST]
        CALL    compare
        LD      t, [RIGHT]
        ADD     g, t
        LD      t, [RIGHT + 1]
        ADC     G, t
        ADD     y, #1
        CMP     y, #8
        JANY    LO, .line

.include "farthest_place.s"

; Is pixel (y, x) at least as far as those before? x is 8 in a row without object pixels.
compare:
        LD      t, [x + MULTIPLE]
        MOV     d, g
        SUB     d, t
        LD      t, [x + HIGH]
        MOV     D, G
        SBC     D, t
        CMP     D, #0x80
        WHERE   HS              ; negative
          MOV   t, #0
          SUB   t, d
          MOV   d, t
          MOV   t, #0
          SBC   t, D
          MOV   D, t
        END
        CMP     x, #8
        WHERE   LO
          CMP   d, most
          MOV   t, D
          SBC   t, MOST
          WHERE HS
            MOV most, d
            MOV MOST, D
            MOV row, y
            MOV col, x
          END
        END
        RET
