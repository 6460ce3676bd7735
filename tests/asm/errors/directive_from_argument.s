.macro do, what
        what 5, x
.endm
        do      .rept
        HALT
