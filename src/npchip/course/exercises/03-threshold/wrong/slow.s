; a second region, or ELSE, costs 64 cycles for each of its lines: give 0 to all NPs first, then 255 to some
.output bright, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #128
        WHERE   HI
          MOV   value, #255
        END
        WHERE   LS
          MOV   value, #0
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
