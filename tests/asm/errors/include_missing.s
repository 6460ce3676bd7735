.include "lib/halve.s"
.include "lib"
.include halves.s
        half    r0
        CMP     r0, #LIMIT
        HALT
