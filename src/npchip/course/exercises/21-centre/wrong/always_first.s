; first is replaced by every dark pixel: only an NP whose first is still 255 takes one
.output center_row, 0, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg last, r3
.reg top, r4
.reg most, r5
.reg t, r6
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     last, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   last, pixel
          MOV   first, pixel
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next

        ROW     t
        SHL     t, #3
        MOV     value, #0
        CMP     first, #255
        WHERE   NE
          MOV   value, #255
          SHR   first, #3
          ADD   first, t
          SUB   value, first
          SHR   last, #3
          ADD   last, t
        END
        CALL    largest
        MOV     top, #255
        SUB     top, most
        MOV     value, last
        CALL    largest
        CMP     top, #255
        WHERE   EQ
          MOV   most, #255
        END
        ADD     top, most
        RCR     top
        OUT     0, top
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
