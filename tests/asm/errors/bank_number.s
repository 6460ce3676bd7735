.equ RESET, 1
        SAMPLE  reset, RESET
        LD      r0, [r1 + 2]
        LD      r0, [r1 + 100]
        HALT
