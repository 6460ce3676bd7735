; the loop: its end costs three cycles a pixel, so write its body 8 times with .rept
.output bright, 0, picture
.reg pixel, r0
.reg value, r1
.reg t, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:
        .rept 1
          LD    value, [pixel]
          MOV   t, #128
          SUB   t, value
          SBC   t, t
          OUT   0, t
          ADD   pixel, #1
        .endr
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
