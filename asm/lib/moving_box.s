; lib/moving_box.s - which pixels move, and the middle of their box
;
; Included by the trajectory programs, which name the registers that it uses (pixel, f, t, rows,
; cols, bits, value, most, base, low, center), the banks SIGNAL, RESET and PREVIOUS, and
; THRESHOLD.
;
; Thesis    2.1.1: frame differencing and the centre of the box

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

; The middle of the box in one axis. Takes value, the moving rows (or columns) of the NP, and
; base, its number. Gives center, the same in every NP.
middle:
        SHL     base, #3
        MOV     f, value
        CMP     f, #0
        WHERE   NE
          CALL  place           ; the first row that moves ...
          MOV   t, #0xFF        ; ... is the largest of 255 - row
          SUB   t, value
          MOV   value, t
        END
        CALL    maximum
        MOV     low, #0xFF
        SUB     low, most
        MOV     value, #0
        SUB     value, f
        AND     value, f        ; the last bit alone
        WHERE   NE
          CALL  place
        END
        CALL    maximum
        MOV     center, low
        ADD     center, most
        RCR     center          ; (low + high) >> 1 in nine bits
        RET

; value := base + place of its leftmost bit; value is not 0
place:
        MOV     t, base
        CMP     value, #0x10
        WHERE   LO
          SHL   value, #4
          ADD   t, #4
        END
        CMP     value, #0x40
        WHERE   LO
          SHL   value, #2
          ADD   t, #2
        END
        CMP     value, #0x80
        WHERE   LO
          ADD   t, #1
        END
        MOV     value, t
        RET

; most := the largest value of all NPs, in every NP. From the highest bit down, the global OR
; tells whether any NP that is still in has the bit; then those without it are out.
maximum:
        MOV     most, #0
        .rept 8, bit
          SHL   value, #1
          JNONE CS, .clear
          SBC   t, t            ; 255 where the bit is set
          AND   value, t
          OR    most, #0x80 >> bit
.clear:
        .endr
        RET
