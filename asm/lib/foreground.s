; lib/foreground.s - routines on a frame's pixels, and on rows of the mask as bits
;
; Included by programs with follow_registers.s.

.if SMOOTH
; Means of eight pixels, from the last one on, with the pixel behind; b: the one behind the last
means:  MOV     k, #8
.pixel: LD      f, [p + SIGNAL]
        ADD     b, f
        RCR     b
        ST      [p + SIGNAL], b
        MOV     b, f
        SUB     p, step
        SUB     k, #1
        JANY    NE, .pixel
        RET
.endif

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
        SUB     pb, b           ; pb is d
        CALL    absolute
        MOV     a, d
        SHR     a, #2
        MOV     d, pf
        SUB     d, f
        CALL    absolute
        SUB     pn, n
        CMP     pn, #(BACK - GHOST) & 0xFF
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

