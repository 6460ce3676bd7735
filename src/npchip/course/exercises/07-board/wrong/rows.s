; NP (7, 9) is white, whose row plus column is 16: add both, then look at the lowest bit of the sum
.output board, 0, plane
        ROW     r0
        AND     r0, #1
        MOV     r0, #0
        WHERE   NE
          MOV   r0, #255
        END
        OUT     0, r0
        HALT
