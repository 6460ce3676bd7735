; what is not brighter is sent as it is: give 0 to all NPs, between CMP and WHERE
.output bright, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #128
        WHERE   HI
          MOV   value, #0
          MOV   value, #255
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
