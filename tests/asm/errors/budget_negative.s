.budget words -1
        HALT
