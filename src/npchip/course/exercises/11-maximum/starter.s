; maximum.s - Eight questions to the array
.output most, 0, scalar
.reg pixel, r0
.reg value, r1
.reg best, r2
.reg most, r3
.reg t, r4
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     most, #0
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
        ; your program
        JMP     frame
