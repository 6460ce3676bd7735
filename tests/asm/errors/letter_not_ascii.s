größe:  ADD     r0, #1
        JMP     größe
