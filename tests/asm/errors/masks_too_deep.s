        .rept   16
        WHERE   LO
        .endr
        .rept   16
        END
        .endr
        HALT
