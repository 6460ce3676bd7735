; 128 itself is not brighter than 128
.output bright, 0, picture
.budget cycles 1120
.reg pixel, r0
.reg value, r1
.reg t, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:
        .rept 8
          LD    value, [pixel]
          MOV   t, #127
          SUB   t, value
          SBC   t, t
          OUT   0, t
          ADD   pixel, #1
        .endr
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
