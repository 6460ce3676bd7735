        CALL    a
        HALT
a:      CALL    b
        RET
b:      CALL    c
        RET
c:      CALL    d
        RET
d:      CALL    e
        RET
e:      ADD     r0, #1
        RET
