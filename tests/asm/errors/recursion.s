        CALL    count
        HALT
count:  SUB     r0, #1
        JNONE   NE, .done
        CALL    count
.done:  RET
