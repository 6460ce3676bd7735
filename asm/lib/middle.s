; lib/middle.s - the middle of a bounding box, the same in every NP
;
; Included by programs that name the registers that it uses: value, base, f, t, most, low, center.
;
; Thesis    2.1.1: the centre of the box

; The middle of the box in one axis. Takes value, the rows (or columns) of the NP in the box, and
; base, its number. Gives center, the same in every NP.
middle:
        SHL     base, #3
        MOV     f, value
        CMP     f, #0
        WHERE   NE
          CALL  place           ; the first row ...    
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
