; lib/place.s - the place of the first set bit
;
; Included by programs that name the registers that it uses: value, base, t.

; value := base + place of its leftmost bit; value is not 0. Changes t.
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
