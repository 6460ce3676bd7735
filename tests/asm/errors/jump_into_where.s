        CMP     r0, #5
        JNONE   LO, .inside
        WHERE   LO
.inside:
          ADD   r0, #1
        END
        HALT
