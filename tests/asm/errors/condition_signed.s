        CMP     r0, r1
        WHERE   LT
          MOV   r0, r1
        END
        WHERE   GE
          MOV   r1, r0
        END
        JANY    Z, done
        WHERE   LOW
        END
done:   HALT
