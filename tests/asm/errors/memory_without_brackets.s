        LD      r0, 64
        LD      r1, r0
        ST      64, r1
        LD      r2, (r0 + 64)
        HALT
