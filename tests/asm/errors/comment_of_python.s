.output first, 0, plane # of every NP
.reg value, r1 # a pixel
.rept 2 # times
        NOP
.endr # done
# The loop.
frame:  EXPOSE   # take the next picture
        SAMPLE  signal, 0 # convert it
        LD      value, [0] # its first pixel
        JANY    LO, frame # too dark
        OUT     #0, value
        JMP     #frame
