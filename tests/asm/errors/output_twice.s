.output count, 0, scalar
.output count, 1, scalar
.output sum, 0, scalar16
.budget words 5
.budget words 6
        OUT     0, r0
        HALT
