; lib/track.s - the square about an expected place, sums over all NPs, and a step of a track
;
; Included by programs with follow_registers.s that have macros expected_row and expected_col, which
; load c, and the constants REACH, BYTE, NEW, life of a new track, and LEAVES: 1 where the pixels of
; an object leave the mask.

; Rows up to dst := the mask in the square of 2*w pixels a side about the expected place
square: expected_row
        ROW     t
        CALL    span
        MOV     rows, bits
        expected_col
        COL     t
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

; bits := those of eight pixels, in the NP of number t, between c - w and c + w - 1
span:   CALL    offset
        SUB     t, #1
        MOV     k, w
        ADD     k, w
        MOV     bits, #1
.bit:   ADD     t, #1
        CMP     t, k
        ADC     bits, bits
        JNONE   CS, .bit
        RET

; t := distance of the first of them from c - w
offset: SHL     t, #3
        SUB     t, c
        ADD     t, w
        RET

; Counts the NP's pixels in eight rows, the first behind y, and adds up their places in the square.
sums:   MOV     w, #REACH
        expected_col
        COL     t
        CALL    offset
        MOV     xoff, t
        expected_row
        ROW     t
        CALL    offset
        MOV     yoff, t
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

; most := 8 * value + 4 of the NPs that are left, the largest; the others are out
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
        SHL     most, #3
        ADD     most, #4
        RET

; S:s := its sum over all NPs
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
        CALL    maximum
        CMP     S, most
        MOV     S, most
        MOV     value, s
        WHERE   NE
          MOV   value, #0
        END
        CALL    maximum
        MOV     s, most
        RET

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

; One axis: takes s, the sum of places, and gives s:x, the place, and there, AHEAD frames later.
; Memory at axis, every BYTE bytes: expected place, high and low byte, velocity, low and high byte.
measure:
        CALL    total
        MOV     x, #0           ; s:x := s / area, bit by bit
        MOV     rl, #0
        MOV     RH, #0
        MOV     E, #24
.bit:   ADD     x, x
        ADC     s, s
        ADC     S, S
        ADC     rl, rl
        ADC     RH, RH
        SUB     rl, area
        SBC     RH, AREA
        WHERE   LO
          ADD   rl, area
          ADC   RH, AREA
        ELSE
          ADD   x, #1
        END
        SUB     E, #1
        JANY    NE, .bit
        LD      S, [axis + VARS]        ; S:t: the expected place
        ADD     axis, #BYTE
        LD      t, [axis + VARS]
        ADD     axis, #BYTE
        LD      vl, [axis + VARS]
        ADD     axis, #BYTE
        LD      vh, [axis + VARS]
        ADD     s, S
        SUB     s, #REACH
        CMP     life, #128
        WHERE   HS              ; missed: as expected
          MOV   x, t
          MOV   s, S
        END
        MOV     e, x            ; what the expected place has missed by
        SUB     e, t
        MOV     E, s
        SBC     E, S
        CMP     life, #NEW
        WHERE   EQ
          MOV   E, #100         ; a new track
        END
        ADD     E, #4
        CMP     E, #8
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
        .rept   (AHEAD >> 1) - (AHEAD >> 3)
        ADD     vl, vl
        ADC     vh, vh
        .endr
        .rept   AHEAD > 1
        CALL    ahead
        .endr
        CMP     there, last     ; half a pixel back, and rounded
        ADC     there, #0
        ADD     x, #128
        ADC     s, #0
        RET

; there:t := s:x + vh:vl, or s:x where that is outside the frame
ahead:  MOV     t, x
        MOV     there, s
        ADD     t, vl
        ADC     there, vh
        CMP     last, there
        WHERE   LO
          MOV   t, x
          MOV   there, s
        END
        RET
