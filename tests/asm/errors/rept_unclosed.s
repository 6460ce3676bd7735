        .rept   8, i
        SHL     r0, #1
        OR      r1, #0x80 >> i
done:   HALT
