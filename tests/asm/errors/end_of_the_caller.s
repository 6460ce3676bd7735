        CMP     r0, #5
        WHERE   LO
          CALL  five
        HALT
five:   MOV     r0, #5
        END
        RET
