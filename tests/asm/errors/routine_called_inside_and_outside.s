        CALL    half
        CMP     r0, #5
        WHERE   LO
          CALL  half
        END
        HALT
half:   SHR     r0, #1
        RET
