; lib/object_box.s - which pixels belong to a bright or a dark object, and the middle of their box
;
; Included by programs that have the memory and registers of object_registers.s, and THRESHOLD and
; DARK, which tracking.s explains.
;
; Thesis    1.3: object tracking; 2.1.1: centre of an object

; Takes a frame. Gives rows and cols, those with the object, as a bit for each, 0 leftmost.
capture:
        EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     pixel, #0
        MOV     cols, #0xFF     ; columns without the object so far
        MOV     rows, #1        ; a sentinel: falls out on the left after eight rows
.row:   .rept 8
        LD      t, [pixel + RESET]
        ADD     t, #THRESHOLD   ; dark where signal < reset + THRESHOLD, in nine bits: where the
        SBC     u, u            ; sum is beyond eight ...
        LD      f, [pixel + SIGNAL]
        CMP     f, t            ; ... or larger than the signal,
        ADC     u, #0xFF        ; there is a carry
        ADC     bits, bits      ; collect one bit for each pixel: 1 = dark
        ADD     pixel, #1
        .endr
.if DARK
        MOV     t, #0xFF
        SUB     t, bits
        MOV     bits, t
.endif
        AND     cols, bits
        CMP     bits, #0xFF     ; lower: some pixel of this row belongs to the object
        ADC     rows, rows
        JNONE   CS, .row
        MOV     t, #0xFF
        SUB     t, cols
        MOV     cols, t
        RET

; Takes rows and cols. Gives row and col, first + last of the box, which is twice its centre.
centre:
        ROW     base            ; in the vertical ...
        MOV     value, rows
        CALL    middle
        ADC     center, center  ; the bit that the half has lost comes back
        MOV     row, center
        COL     base            ; ... and in the horizontal
        MOV     value, cols
        CALL    middle
        ADC     center, center
        MOV     col, center
        RET

.include "middle.s"

.include "threshold.s"
