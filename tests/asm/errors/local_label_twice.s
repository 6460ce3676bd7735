main:   ADD     r0, #1
.skip:  ADD     r1, #1
        JNONE   EQ, .skip
.skip:  HALT
