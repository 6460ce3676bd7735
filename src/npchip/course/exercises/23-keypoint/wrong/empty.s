; in an empty picture the column is 255 as well: NPs without a pixel take no part
.output row, 0, scalar
.output col, 1, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg row, r3
.reg most, r4
.reg t, r5
.reg top, r6
.reg col, r7
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     pixel, #64
.next:  SUB     pixel, #1
        LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   first, pixel
        END
        CMP     pixel, #0
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
        CALL    largest
        MOV     top, #255
        SUB     top, most
        OUT     0, top
        MOV     col, #255
        CMP     row, top
        WHERE   EQ
          COL   col
          SHL   col, #3
          AND   first, #7
          ADD   col, first
        END
        MOV     value, #255
        SUB     value, col
        CALL    largest
        MOV     col, #255
        SUB     col, most
        OUT     1, col
        JMP     frame

largest:
        MOV     most, #0
        .rept 8, bit
          SHL   value, #1
          JNONE CS, .clear
          SBC   t, t
          AND   value, t
          OR    most, #0x80 >> bit
.clear:
        .endr
        RET
