        CMP     r0, #5
        IF      LO
          MOV   r0, #5
        ENDIF
        HALT
