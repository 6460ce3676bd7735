        CMP     r0, #5
        WHERE   LO
          ADD   r0, #1
          JNONE LO, done
        END
done:   HALT
