; lib/foreground.s - routines on a frame's pixels, and on rows of the mask as bits
;
; Included by programs with follow_registers.s.

; Takes a frame, and means of 2 x 2 of its pixels.
take:   EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     p, #63
.cds:   cds     f, p, t
        ST      [p + SIGNAL], f
        SUB     p, #1
        JANY    HS, .cds
        MOV     step, #1
        MOV     p, #0
.row:   LD      b, [p + SIGNAL]
        NBR     b, b, east
        ADD     p, #7
        CALL    means
        ADD     p, #9
        CMP     p, #64
        JANY    LO, .row
        MOV     step, #8
        MOV     p, #7
.col:   LD      b, [p + SIGNAL]
        NBR     b, b, south
        ADD     p, #56
        CALL    means
        ADD     p, #8 - 1       ; the column before; C: it exists
        JANY    CS, .col
        RET

; Means of eight pixels, from the last one on, with the pixel behind; b: the one behind the last
means:  MOV     k, #8
.pixel: LD      f, [p + SIGNAL]
        MOV     t, f
        ADD     f, b
        RCR     f
        ST      [p + SIGNAL], f
        MOV     b, t
        SUB     p, step
        SUB     k, #1
        JANY    NE, .pixel
        RET

; d := |d|. Takes C from the subtraction. Changes t.
absolute:
        WHERE   LO
          MOV   t, #0
          SUB   t, d
          MOV   d, t
        END
        RET

; The last pixel of a row or column of the NP
ends:   MOV     a, p
        ADD     a, far
        LD      pf, [a + SIGNAL]
        LD      pb, [a + BACKGROUND]
        LD      pn, [a + CODE]
        RET

; Takes the ghosts among eight pixels into the background.
peel:   MOV     k, #8
.pixel: LD      f, [p + SIGNAL]
        LD      b, [p + BACKGROUND]
        LD      n, [p + CODE]
        MOV     d, pb
        SUB     d, b
        CALL    absolute
        MOV     a, d
        SHR     a, #2
        MOV     d, pf
        SUB     d, f
        CALL    absolute
        MOV     t, pn
        SUB     t, n
        CMP     t, #(BACK - GHOST) & 0xFF
        WHERE   EQ
          CMP   d, a
          WHERE LO
            MOV b, f
            ST  [p + BACKGROUND], b
            MOV n, #BACK
            ST  [p + CODE], n
          END
        END
        MOV     pf, f
        MOV     pb, b
        MOV     pn, n
        ADD     p, step
        SUB     k, #1
        JANY    NE, .pixel
        RET

; Gets the neighbours' rows next to the NP's own. Gives y, the last row.
borders:
        LD      t, [VARS + 8]
        NBR     t, t, north
        ST      [VARS], t
        LD      t, [VARS + 1]
        NBR     t, t, south
        ST      [VARS + 9], t
        MOV     y, #8
        RET

; m := row y; h: pixels with a neighbour beside; v: with one above or below
around: LD      m, [y + VARS]
        NBR     t, m, west
        SHR     t, #1
        MOV     h, m
        RCR     h
        NBR     t, m, east
        SHL     t, #1
        MOV     t, m
        ADC     t, t
        OR      h, t
        MOV     at, y
        SUB     at, #1
        LD      v, [at + VARS]
        ADD     at, #2
        LD      t, [at + VARS]
        OR      v, t
        RET

