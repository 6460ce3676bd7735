        JMP     done
        NOP             ; npchip: allow NPW04
        NOP             ; npchip: allow NPW4 the second version needs it
        NOP             ; npchip: allow NP018 it is nearly short enough
        NOP             ; npchip: allow because I say so
        NOP             ; npchip: alow NPW04 the second version needs it
done:   HALT
