        LD      r0, [r1 + r2]
        LD      r0, [64 + r1]
        LD      r0, [r1 - 64]
        LD      r0, [r1 + 64
        HALT
