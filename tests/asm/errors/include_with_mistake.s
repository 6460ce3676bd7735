.include "lib/mistakes.s"
        half    r0
        third   r0
        HALT
