; that is the largest of the last pixels: ask for the bits of best, not of value
.output most, 0, scalar
.reg pixel, r0
.reg value, r1
.reg best, r2
.reg most, r3
.reg t, r4
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     best, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     best, value
        WHERE   LO
          MOV   best, value
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     most, #0
        .rept 8, bit
          SHL   value, #1
          JNONE CS, .clear
          SBC   t, t
          AND   value, t
          OR    most, #0x80 >> bit
.clear:
        .endr
        OUT     0, most
        JMP     frame
