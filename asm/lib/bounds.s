; lib/bounds.s - the first and the last row (or column) of a bounding box
;
; The beginning of a routine. Takes value, the rows of the NP in the box as a bit for each, y = 0
; leftmost, and base, its number. Gives low, the first row of all NPs, the same in every NP. It
; goes on behind the file with value, of which the largest of all NPs is the last row.
;
; Included by programs that have the registers of box_registers.s and the routines of place.s and
; maximum.s. Changes f, t, most and base.
;
; Thesis    2.1.1: the bounding box

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
