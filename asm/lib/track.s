; lib/track.s - the square about an expected place, sums over all NPs, and a step of a track
;
; Included by programs with follow_registers.s that have macros expected_row and expected_col, which
; load c (WIDE: and C, the high byte), and the constants REACH; YOFF and XOFF, two bytes; BYTE; NEW,
; life of a new track; and LEAVES: 1 where the pixels of an object leave the mask.

; Rows up to dst := the mask in the square of 2*w pixels a side about the expected place
square: LD      t, [YOFF]
        CALL    span
        MOV     rows, bits
        LD      t, [XOFF]
        CALL    span
        MOV     y, #8
.row:   LD      m, [y + SOLID]
        AND     m, bits
        SHR     rows, #1
        SBC     t, t
        AND     m, t
        ST      [dst], m
        SUB     dst, #1
        SUB     y, #1
        JANY    NE, .row
        RET

; bits := those of eight pixels that lie less than w from the expected one; t: see offset
span:   SUB     t, #REACH + 1
        ADD     t, w
        MOV     k, w
        ADD     k, w
        MOV     bits, #1
.bit:   ADD     t, #1
        CMP     t, k
        ADC     bits, bits
        JNONE   CS, .bit
        RET

; t := distance of the first pixel of the NP of number t from the edge of the square about c
offset:
.if WIDE
        MOV     T, t            ; in 16 bits
        SHL     t, #3
        SHR     T, #5
        SUB     t, c
        SBC     T, C
        ADD     t, #REACH + 8
        ADC     T, #0
        CMP     T, #1
        SBC     T, T
        AND     t, T            ; where it does not fit into 8: just before the edge
        SUB     t, #8
.else
        SHL     t, #3
        SUB     t, c
        ADD     t, #REACH
.endif
        RET

; Counts the NP's pixels in eight rows, the first behind y, and adds up their places in the square.
sums:   LD      xoff, [XOFF]
        LD      yoff, [YOFF]
        MOV     area, #0
        MOV     down, #0
        MOV     DOWN, #0
        MOV     right, #0
        MOV     RIGHT, #0
.row:   ADD     y, #1
        LD      m, [y + VARS]
        .if     LEAVES
        LD      t, [y + SOLID]
        SUB     t, m
        ST      [y + SOLID], t
        .endif
        MOV     t, xoff
.bit:   SHL     m, #1
        WHERE   CS
          ADD   area, #1
          ADD   down, yoff
          ADC   DOWN, #0
          ADD   right, t
          ADC   RIGHT, #0
        END
        ADD     t, #1
        CMP     m, #0
        JANY    NE, .bit
        ADD     yoff, #1
        MOV     t, y
        AND     t, #7
        JANY    NE, .row
        RET

; most := the largest value of the NPs that are left; the others are out. s := 8 * most + 4; WIDE:
; S:s
choose: CMP     area, #0
        WHERE   EQ
          MOV   value, #0
        END
        MOV     s, value
        CALL    maximum
        CMP     s, most
        WHERE   NE
          MOV   area, #0
        END
        MOV     s, most
        SHL     s, #3
        ADD     s, #4
.if WIDE
        MOV     S, most
        SHR     S, #5
.endif
        RET

; S:most := the sum of s over all NPs
total8: MOV     S, #0

; S:most := the sum of S:s over all NPs
total:  MOV     k, #NP_COLS - 1
        MOV     t, s
        MOV     rl, S
.east:  NBR     t, t, west
        NBR     rl, rl, west
        ADD     s, t
        ADC     S, rl
        SUB     k, #1
        JANY    NE, .east
        MOV     k, #NP_ROWS - 1
        MOV     t, s
        MOV     rl, S
.south: NBR     t, t, north
        NBR     rl, rl, north
        ADD     s, t
        ADC     S, rl
        SUB     k, #1
        JANY    NE, .south
        MOV     value, S        ; the largest is that of the last NP
        CALL    maximum         ; leaves value 0
        CMP     S, most
        MOV     S, most
        WHERE   EQ
          MOV   value, s
        END

; most := the largest value of all NPs. Changes t, k and value.
maximum:
        MOV     most, #0
        MOV     k, #0x80
.bit:   SHL     value, #1
        JNONE   CS, .clear
        SBC     t, t            ; 255 where the bit is set: the others are out
        AND     value, t
        OR      most, k
.clear: SHR     k, #1
        JNONE   CS, .bit
        RET

; there:t := s:x + vh:vl, or s:x where that is outside the frame; WIDE: THERE:there:t, S:s:x
ahead:
.if WIDE
        MOV     t, vh
        SHL     t, #1
        SBC     THERE, THERE
        MOV     t, x
        MOV     there, s
        ADD     t, vl
        ADC     there, vh
        ADC     THERE, S
        MOV     e, LAST
        CMP     last, there
        SBC     e, THERE
        JANY    HS, .inside
        MOV     THERE, S
.else
        MOV     t, x
        MOV     there, s
        ADD     t, vl
        ADC     there, vh
        CMP     last, there
        JANY    HS, .inside
.endif
        MOV     t, x
        MOV     there, s
.inside: RET

; One axis: takes S:s, the sum of places, and gives s:x, the place, and there, AHEAD frames later;
; WIDE: S:s:x and THERE:there. Memory at axis, every BYTE bytes: expected place, high and low byte,
; velocity, low and high byte; WIDE: the place has a higher byte before these.
measure:
        CALL    total           ; leaves 0 in k, which is x, and in value, which is RH
        MOV     s, most         ; s:x := S:s / area, bit by bit
        MOV     rl, S           ; the quotient has 16 bits
        MOV     E, #16
.bit:   ADD     x, x
        ADC     s, s
        ADC     rl, rl
        ADC     RH, RH
        OR      x, #1
        SUB     rl, area
        SBC     RH, AREA
        JANY    HS, .fits
        SUB     x, #1
        ADD     rl, area
        ADC     RH, AREA
.fits:  SUB     E, #1
        JANY    NE, .bit
.if WIDE
        LD      S, [axis + VARS]
        ADD     axis, #BYTE
.endif
        LD      pixel, [axis + VARS] ; pixel:t: the expected place
        ADD     axis, #BYTE
        LD      t, [axis + VARS]
        ADD     axis, #BYTE
        LD      vl, [axis + VARS]
        ADD     axis, #BYTE
        LD      vh, [axis + VARS]
        CMP     life, #128
        JANY    LO, .seen
        MOV     x, t            ; missed: as expected
        MOV     s, #REACH
.seen:  ADD     s, pixel
.if WIDE
        ADC     S, #0
.endif
        SUB     s, #REACH
.if WIDE
        SBC     S, #0
.endif
        MOV     e, x            ; what the expected place has missed by
        SUB     e, t
        MOV     E, s
        SBC     E, pixel
        ADD     E, #4
        CMP     life, #NEW
        WHERE   NE              ; HS for a new track
          CMP   E, #8
        END
        WHERE   LO
          SHR   e, #3
          SHL   E, #5
          OR    e, E            ; an eighth of it, and 128
          ADD   vl, e
          ADC   vh, #0
          SUB   vl, #128
          SBC   vh, #0
        ELSE                    ; a surprise
          MOV   vl, #0
          MOV   vh, #0
        END
        ST      [axis + VARS], vh
        SUB     axis, #BYTE
        ST      [axis + VARS], vl
        SUB     axis, #BYTE
        CALL    ahead
        ST      [axis + VARS], t
        SUB     axis, #BYTE
        ST      [axis + VARS], there
.if WIDE
        SUB     axis, #BYTE
        ST      [axis + VARS], THERE
.endif
        .rept   (AHEAD >> 1) - (AHEAD >> 3)
        ADD     vl, vl
        ADC     vh, vh
        .endr
        .rept   AHEAD > 1
        CALL    ahead
        .endr
.if SMOOTH                      ; half a pixel back, and rounded
.if WIDE
        MOV     t, THERE
        CMP     there, last
        SBC     t, LAST
.else
        CMP     there, last
.endif
.else                           ; rounded
        ADD     t, #128
.endif
        ADC     there, #0
.if WIDE
        ADC     THERE, #0
.endif
        ADD     x, #128
        ADC     s, #0
.if WIDE
        ADC     S, #0
.endif
.if LEAVES == 0                 ; nothing but 0 is sent of what is missed
        CMP     life, #128
        SBC     t, t
        AND     x, t
        AND     s, t
        AND     there, t
.if WIDE
        AND     S, t
        AND     THERE, t
.endif
.endif
        RET
