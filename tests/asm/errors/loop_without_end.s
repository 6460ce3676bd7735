frame:  EXPOSE
        MOV     r0, #0
.pixel: LD      r1, [r0 + 64]
        CMP     r1, #10
        WHERE   LO
          MOV   r1, #10
        ADD     r0, #1
        CMP     r0, #64
        JANY    LO, .pixel
        JMP     frame
