; pixel.s - One pixel
.output corner, 0, plane
frame:  EXPOSE
        ; your program
        JMP     frame
