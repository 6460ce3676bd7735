        CMP     r0, #5
        ELSE
          MOV   r0, #5
        END
        HALT
