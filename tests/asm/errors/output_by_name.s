.output corner, 3, plane
        OUT     corner, r0
        OUT     corners, r0
        MOV     r0, #corner
        HALT
