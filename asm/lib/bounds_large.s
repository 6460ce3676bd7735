; lib/bounds_large.s - the first and the last row (or column) of a bounding box, in 16 bits
;
; Included by programs that have the registers of box_registers.s, and LOW, high and HIGH. The first
; row of a box is in the first row of NPs that has any, and there it is the highest bit of all NPs.
;
; Thesis    2.1.1: the bounding box

; Takes value, the rows (or columns) of the NP in the box as a bit for each, y = 0 leftmost, and
; base, its number; some NP has any. Gives LOW:low, the first row of all NPs, and HIGH:high, the last one, the same
; in every NP. Changes f, t, value and most.
bounds: MOV     f, value
        CMP     f, #0
        WHERE   NE
          MOV   value, #255
          SUB   value, base
        END
        CALL    maximum
        MOV     LOW, #255       ; the first NPs with any ...
        SUB     LOW, most
        MOV     value, #0
        CMP     base, LOW
        WHERE   EQ
          MOV   value, f
        END
        CALL    maximum         ; ... and their highest bit
        MOV     low, LOW
        SHL     low, #3
        SHR     LOW, #5
        .loop   8
.first: CMP     most, #0x80
        JNONE   LO, .last
        ADD     most, most
        ADD     low, #1
        JMP     .first
.last:  MOV     value, #0
        CMP     f, #0
        WHERE   NE
          MOV   value, base
        END
        CALL    maximum
        MOV     HIGH, most      ; the last NPs with any ...
        MOV     value, #0
        CMP     f, #0
        WHERE   NE
          CMP   base, HIGH
          WHERE EQ
            MOV t, #0
            SUB t, f
            AND t, f
            MOV value, #255
            SUB value, t
          END
        END
        CALL    maximum         ; ... and their lowest bit
        MOV     t, #255
        SUB     t, most
        MOV     high, HIGH
        SHL     high, #3
        ADD     high, #7
        SHR     HIGH, #5
        .loop   8
.bit:   SHR     t, #1
        JNONE   NE, .end
        SUB     high, #1
        JMP     .bit
.end:   RET

.include "maximum.s"
