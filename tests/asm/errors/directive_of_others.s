.set LIMIT, 5
.define WIDTH, 8
.repeat 3, i
        ADD     r0, #LIMIT + WIDTH + i
.endrepeat
.macro half, a
        SHR     a, #1
.endmacro
.if WIDTH == 8
        half    r0
.elseif WIDTH == 16
        half    r1
.fi
        HALT
