; lib/maximum.s - the largest value of all NPs
;
; Included by programs that name the registers that it uses: value, t, most.

; most := the largest value of all NPs, in every NP. From the highest bit down, the global OR
; tells whether any NP that is still in has the bit; then those without it are out. Changes value
; and t.
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
