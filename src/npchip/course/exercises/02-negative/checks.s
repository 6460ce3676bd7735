; checks.s - what npchip learn check looks at
;
; expect: words <= 14
; expect: cycles <= 1250 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: picture == null ; nothing is sent in this frame
; run: levels levels=0,100,255
; expect: picture == 255, 155, 0 points=3
; mistake: picture == 1, 101, 0 ; you compute value - 255: the 255 belongs into the destination of SUB
; mistake: picture == 0, 100, 255 ; the picture is sent as it is: nothing is subtracted
; mistake: picture[1][0, 1] == 55 ; each pixel is subtracted from what the one before has left: 255 goes into the register anew for every pixel, inside the loop
; run: drawn frames=shapes_drawn
; expect: picture[0][0, 0] == 0
; expect: picture[0][31, 40] == 255
; expect: sum(picture[0]) == 298128
; mistake: picture[0][31, 40] == 0 ; the picture is sent as it is: nothing is subtracted
