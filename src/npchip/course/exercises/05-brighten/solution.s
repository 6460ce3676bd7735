; solution.s - brighter by 60, at most 255
;
; A better one would do without the mask: after ADD, `SBC t, t` is 255 where the sum did not fit and
; 0 elsewhere, and `OR value, t` is then right in both cases. One instruction less.
;
; expect: words <= 15
; expect: cycles <= 1300 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: steps levels=0,100,195,196,255
; expect: picture == 60, 160, 255, 255, 255 points=3
; mistake: picture == 0, 100, 195, 196, 255 ; the pixels are sent as they are: add 60 first
; mistake: picture == 60, 160, 255, 0, 59 ; 8 bits are full: 196 + 60 is 256, which wraps to 0; C tells where
; mistake: picture[4] == 195 ; that is 60 darker, as in the example of the page: brighter is ADD
; mistake: picture == 255, 255, 255, 0, 59 ; the condition is the wrong way round: C is set where the sum did not fit
; mistake: picture == 60, 160, 255, 0, 0 ; black where it should be white: what does not fit becomes 255
; run: drawn frames=shapes_drawn
; expect: sum(picture[0]) == 1080544 points=2
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: mouse frames=mouse_run first=2
; expect: golden outputs

.output picture, 0, picture
.reg pixel, r0
.reg value, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        ADD     value, #60
        WHERE   CS
          MOV   value, #255
        END
        OUT     0, value
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
