        SAMPLE  0, signal
        SAMPLE  exposed, 0
        SAMPLE  signal
        HALT
