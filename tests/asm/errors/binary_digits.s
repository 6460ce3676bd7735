        AND     r0, #0b1012
        OR      r0, #0x
        HALT
