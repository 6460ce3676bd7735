        CMP     r0, #'A
        CMP     r0, #'AB'
        HALT
