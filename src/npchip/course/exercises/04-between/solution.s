; solution.s - 255 where 64 <= value <= 192
;
; A better one would compare once: value - 64 wraps round for what lies below 64, so that
; value - 64 <= 128, unsigned, says both. `SUB value, #64`, `CMP value, #129`, and `SBC out, out`
; makes 255 of the carry: no mask at all.
;
; expect: words <= 20
; expect: cycles <= 1600 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: error == NP311 ; a picture takes exactly 64 sends a frame; if it is one, the loop never goes back: JANY LO does, below 64
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; run: steps levels=0,63,64,65,191,192,193,255
; expect: middle == 0, 0, 255, 255, 255, 255, 0, 0 points=3
; mistake: middle == 0 ; everything is black: no NP reaches the line that sets 255
; mistake: middle == 0, 0, 0, 255, 255, 0, 0, 0 ; the limits themselves are left out: HS and LS keep them
; mistake: middle == 0, 0, 255, 255, 255, 255, 255, 255 ; the upper limit has no effect: is its WHERE inside the first?
; mistake: middle == 255, 255, 255, 255, 255, 255, 255, 255 ; one of two conditions is enough here: put one WHERE inside the other
; run: drawn frames=shapes_drawn
; expect: sum(middle[0]) == 11730 points=2
; run: photo frames=shapes_photo
; expect: golden outputs points=3
; run: coin frames=coin_slide first=8
; expect: golden outputs

.output middle, 0, picture
.reg pixel, r0
.reg value, r1
.reg out, r2
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        MOV     out, #0
        CMP     value, #64
        WHERE   HS
          CMP   value, #192
          WHERE LS
            MOV out, #255
          END
        END
        OUT     0, out
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        JMP     frame
