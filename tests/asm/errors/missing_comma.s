        MOV     r0 #5
        ADD     r0 r1
        JANY    LO done
done:   HALT
