.macro half, a
        SHR     a, #1

.macro double, a
        SHL     a, #1
.endm

frame:  EXPOSE
        half    r0
        double  r1
        JMP     frame
