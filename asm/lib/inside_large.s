; lib/inside_large.s - the end of a routine: f:value, 16 bits, signed, kept between 0 and LOW:low
;
; Changes t. Included by programs with trajectory_large.s.

        CMP     f, #0x80
        WHERE   HS              ; negative
          MOV   value, #0
          MOV   f, #0
        END
        CMP     low, value
        MOV     t, LOW
        SBC     t, f
        WHERE   LO              ; beyond the edge
          MOV   value, low
          MOV   f, LOW
        END
        RET
