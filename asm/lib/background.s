; lib/background.s - from frames to the code of each pixel; the background learns
;
; A part of programs with foreground.s that jump to frame for the next one. Uses turn, a register,
; or TURN, a byte: its highest bit changes in every frame. The first frame is the background.
; GHOSTS: a pixel of the mask is likely a ghost where its surroundings lie on the picture's side of
; the middle between picture and background. MEAN, a byte, is 1 and a quarter of the background's
; mean in the NP; a missing NP gives 0. Otherwise any pixel of the mask may be a ghost.

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
.if SMOOTH                      ; means of 2 x 2 pixels
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
.endif

; ---- what differs from the background

.if GHOSTS
        LD      n, [MEAN]       ; level: of the NPs beside, together; a missing one is as its own
        NBR     level, n, west
        CMP     level, #0
        WHERE   EQ
          MOV   level, n
        END
        NBR     t, n, east
        CMP     t, #0
        WHERE   EQ
          MOV   t, n
        END
        ADD     level, t
        MOV     sum, #0
        MOV     SUM, #1
.endif
.ifdef turn
        ADD     turn, #128
.else
        LD      t, [TURN]
.if GHOSTS == 0
        MOV     level, t        ; 0 in the first frame
        OR      t, #1
.endif
        ADD     t, #128
        ST      [TURN], t
.endif
        SBC     slow, slow
        MOV     p, #63
.pixel:
.if SMOOTH
        LD      f, [p + SIGNAL]
.else
        cds     f, p, t
        ST      [p + SIGNAL], f
.endif
        LD      b, [p + BACKGROUND]
        CMP     level, #0
        WHERE   EQ              ; the first frame
          MOV   b, f
        END
        MOV     d, f
        SUB     d, b
        SBC     u, u
        CALL    absolute
.if GHOSTS
        MOV     n, u
.endif
        CMP     b, f
        ADC     u, #0           ; towards the picture, or 0
.if GHOSTS
        ADD     f, b            ; a quarter of the middle, twice
        RCR     f
        SHR     f, #1
        CMP     level, f
        ADC     n, #GHOST       ; 1 more or less: no ghost
.else
        MOV     n, #GHOST
.endif
        CMP     d, #THRESHOLD
        WHERE   HS
          AND   u, slow
        ELSE
          MOV   n, #BACK
        END
        ST      [p + CODE], n
        ADD     b, u
        ST      [p + BACKGROUND], b
.if GHOSTS
        ADD     sum, b
        ADC     SUM, #0
.endif
        SUB     p, #1
        JANY    HS, .pixel
.if GHOSTS
        ST      [MEAN], SUM
.endif
