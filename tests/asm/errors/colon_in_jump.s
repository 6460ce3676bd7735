loop:   JMP     loop:
