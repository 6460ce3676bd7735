; lib/middle.s - the middle of a bounding box, the same in every NP
;
; Included by programs that have the registers of box_registers.s.
;
; Thesis    2.1.1: the centre of the box

; The middle of the box in one axis. Takes value, the rows (or columns) of the NP in the box, and
; base, its number. Gives center, the same in every NP.
middle:
.include "bounds.s"
        CALL    maximum
        MOV     center, low
        ADD     center, most
        RCR     center          ; (low + high) >> 1 in nine bits
        RET

.include "place.s"

.include "maximum.s"
