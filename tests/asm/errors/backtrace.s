.macro store, bank, reg
        ST      [r0 + bank], reg
.endm
.macro both, bank
        store   bank, r1
        store   bank + 32, r2
.endm
.macro all
        .rept   2, i
        both    64 * i
        .endr
.endm
        all
        HALT
