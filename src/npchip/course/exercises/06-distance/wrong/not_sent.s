; the pixels are sent as they are: subtract 100 first, or OUT sends another register than the one with the distance
.output distance, 0, picture
.reg pixel, r0
.reg value, r1
.reg other, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        MOV     r3, value
        SUB     r3, #100
        WHERE   LO
          MOV   other, r3
          MOV   r3, #0
          SUB   r3, other
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
