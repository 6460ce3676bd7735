        CALL    limit
        HALT
limit:  CMP     r0, #5
        WHERE   LO
          MOV   r0, #5
          RET
        END
        RET
