        .rept   end - start
        NOP
        .endr
start:  ADD     r0, #1
end:    HALT
