.budget 100
.budget word 100
.budget words
.budget words 10, 20
        HALT
