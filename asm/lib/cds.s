; lib/cds.s - correlated double sampling of a pixel
;
; Included by programs that name the banks SIGNAL and RESET.

; to := signal - reset of the pixel at place, at least 0. Changes spare.
.macro cds to, place, spare
        LD      to, [place + SIGNAL]
        LD      spare, [place + RESET]
        SUB     to, spare
        WHERE   LO
          MOV   to, #0
        END
.endm
