; lib/farthest_place.s - products, and the place of the largest one in the array
;
;       locate          the place of the largest number in the array
;       product         a product of 8 by 16 bits, added to 16 bits
;       maximum         the largest byte in the array
;
; Included by programs that name the registers that it uses: row, col, most, MOST, in, value, bits,
; best, t, and for products u, w, W, g, G.

; row, col := the place of the largest MOST:most of all NPs that are in, of equals the last one.
; Takes row and col in the NP.
locate: ROW     t               ; its place in the frame
        SHL     t, #3
        ADD     row, t
        COL     t
        SHL     t, #3
        ADD     col, t
        MOV     value, MOST     ; the largest product: high byte, low byte
        CALL    maximum
        MOV     value, most
        CALL    maximum
        MOV     value, row      ; the last row, and the last column in it
        CALL    maximum
        MOV     row, best
        MOV     value, col
        CALL    maximum
        MOV     col, best
        RET

; g:G := g:G + u * w:W. Takes u from a subtraction, C where it is negative. Changes all three.
product:
        WHERE   LO              ; both change their signs
          MOV   t, #0
          SUB   t, u
          MOV   u, t
          MOV   t, #0
          SUB   t, w
          MOV   w, t
          MOV   t, #0
          SBC   t, W
          MOV   W, t
        END
.bit:   SHR     u, #1
        WHERE   CS
          ADD   g, w
          ADC   G, W
        END
        ADD     w, w
        ADC     W, W
        CMP     u, #0
        JANY    NE, .bit
        RET

; best := the largest value of all NPs that are in; those with less are out. From the highest bit
; down, the global OR tells whether any has the bit; then those without it have lost.
maximum:
        MOV     bits, value
        AND     bits, in
        MOV     best, #0
        .rept 8, bit
          SHL   bits, #1
          JNONE CS, .clear
          SBC   t, t
          AND   bits, t
          OR    best, #0x80 >> bit
.clear:
        .endr
        CMP     value, best
        WHERE   NE
          MOV   in, #0
        END
        RET
