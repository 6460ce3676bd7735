.error "漢字, é" + 5
        HALT
