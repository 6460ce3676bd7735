        LD      r0, [256]
        ST      [-1], r0
        JMP     600
