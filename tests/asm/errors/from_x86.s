        XOR     r0, r0
        INC     r0
        MUL     r1
        PUSH    r0
        NEG     r0
        JNZ     done
        CLR     r1
done:   HLT
