; all but one are white: AND #1 keeps the lowest bit alone, and WHERE NE must follow that
.output board, 0, plane
        ROW     r0
        COL     r1
        ADD     r0, r1
        MOV     r0, #0
        WHERE   NE
          MOV   r0, #255
        END
        OUT     0, r0
        HALT
