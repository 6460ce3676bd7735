; black and white are exchanged: which NPs does your condition keep?
.output board, 0, plane
        ROW     r0
        COL     r1
        ADD     r0, r1
        AND     r0, #1
        MOV     r0, #0
        WHERE   EQ
          MOV   r0, #255
        END
        OUT     0, r0
        HALT
