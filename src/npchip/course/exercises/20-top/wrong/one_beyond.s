; a white picture has a dark pixel: the byte at 64 is none of the picture, so subtract 1 from pixel before LD
.output top, 0, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg row, r3
.reg most, r4
.reg t, r5
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     pixel, #64
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   first, pixel
        END
        SUB     pixel, #1
        JANY    NE, .next
        MOV     row, #255
        CMP     first, #255
        WHERE   NE
          ROW   row
          SHL   row, #3
          MOV   t, first
          SHR   t, #3
          ADD   row, t
        END
        MOV     value, #255
        SUB     value, row
        MOV     most, #0
        .rept 8, bit
          SHL   value, #1
          JNONE CS, .clear
          SBC   t, t
          AND   value, t
          OR    most, #0x80 >> bit
.clear:
        .endr
        MOV     value, #255
        SUB     value, most
        OUT     0, value
        JMP     frame
