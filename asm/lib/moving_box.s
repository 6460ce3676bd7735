; lib/moving_box.s - in which rows and columns pixels move
;
; Included by programs that have box_registers.s, THRESHOLD and PREVIOUS, a bank; middle.s, or
; bounds_large.s, then finds the box. Changes pixel, f, t and bits.
;
; Thesis    2.1.1: frame differencing

; Takes a frame and compares it with the one before. Gives rows and cols.
capture:
        EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     pixel, #0
        MOV     cols, #0xFF     ; columns without motion so far
        MOV     rows, #1        ; a sentinel: falls out on the left after eight rows
.row:   MOV     bits, #1        ; the same for eight pixels
.pixel: LD      f, [pixel + SIGNAL]
        LD      t, [pixel + RESET]
        SUB     f, t            ; correlated double sampling
        WHERE   LO
          MOV   f, #0
        END
        LD      t, [pixel + PREVIOUS]
        ST      [pixel + PREVIOUS], f
        ADD     pixel, #1
        ; Still where -THRESHOLD < f - t < THRESHOLD, in 16 bits: t:f becomes f - t, then
        ; f - t + THRESHOLD - 1, which borrows when 2 * THRESHOLD - 1 is taken away.
        SUB     f, t
        SBC     t, t
        ADD     f, #THRESHOLD - 1
        ADC     t, #0
        SUB     f, #(2 * THRESHOLD - 1) & 0xFF
        SBC     t, #(2 * THRESHOLD - 1) >> 8
        ADC     bits, bits      ; collect one bit for each pixel: 1 = still
        JNONE   CS, .pixel
        AND     cols, bits
        CMP     bits, #0xFF     ; lower: some pixel of this row moves
        ADC     rows, rows
        JNONE   CS, .row
        MOV     t, #0xFF
        SUB     t, cols
        MOV     cols, t
        RET

.include "threshold.s"
