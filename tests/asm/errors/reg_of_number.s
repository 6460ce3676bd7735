.reg pixel, 0
.reg value, r16
.reg mask,
        MOV     pixel, value
        MOV     mask, pixel
        HALT
