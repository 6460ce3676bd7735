        CMP     r0, #5
        WHERE   LO
          MOV   r0, #5
        END
        END
        HALT
