frame:  EXPOSE
        CMP     r0, #200
        WHERE   HI
          JMP   found
        END
        JMP     send
found:  MOV     r1, #1
send:   OUT     0, r1
        JMP     frame
