        ROW     r0
        CMP     r0, #4
        WHERE   LO
          OUT   0, r0
        HALT
