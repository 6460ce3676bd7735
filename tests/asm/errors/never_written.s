; the register of the comparison is not the one that was loaded
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r1, [5]
        CMP     r2, #128
        WHERE   HI
          MOV   r1, #255
        END
        OUT     0, r1
        JMP     frame
