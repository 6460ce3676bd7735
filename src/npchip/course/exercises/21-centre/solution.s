; solution.s - the row of the centre of what is dark
;
; A better one would serve both axes: the columns follow from the same loop, by pixel & 7, with two
; more calls. asm/tracking.s of npchip has box, centre and area.
;
; expect: words <= 120
; expect: cycles <= 1250 points=2
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: center_row == null ; nothing is sent yet: top, bottom, and the mean of the two
; run: flat levels=255,50
; expect: center_row == 255, 31 points=2
; mistake: center_row[1] == 0 ; that is the top: the bottom belongs to the mean
; mistake: center_row[1] == 59 ; top is the largest first row: of 255 - x the largest is the smallest x
; mistake: center_row[1] == 35 ; first is replaced by every dark pixel: only an NP whose first is still 255 takes one
; mistake: center_row[0] == 28 ; first begins with 0, which is a pixel: 255 is none
; mistake: center_row[0] == 127 ; without a dark pixel the answer is 255: bottom must be 255 too, and the mean needs RCR
; run: drawn frames=shapes_drawn
; expect: center_row == 28, 31, 31, 31 points=3
; mistake: center_row[0] == 56 ; that is the sum of top and bottom: halve it
; mistake: center_row[0] == 48 ; that is the bottom: the top belongs to the mean
; mistake: center_row[0] <= 7 ; rows within an NP: add 8 times the number of the NP's row
; run: mouse frames=mouse_run
; expect: golden outputs points=3
; run: rises frames=rises.gif
; expect: golden outputs
; mistake: center_row[8] > 20 ; an NP keeps its last row of an earlier frame: begin anew in every one
; run: coin frames=coin_slide
; expect: golden outputs
; mistake: center_row[0] == 127 ; without a dark pixel the answer is 255: bottom must be 255 too, and the mean needs RCR

.output center_row, 0, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg last, r3
.reg top, r4
.reg most, r5
.reg t, r6
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     last, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   last, pixel
          CMP   first, #255
          WHERE EQ
            MOV first, pixel
          END
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next

        ROW     t
        SHL     t, #3
        MOV     value, #0
        CMP     first, #255
        WHERE   NE
          MOV   value, #255
          SHR   first, #3
          ADD   first, t
          SUB   value, first
          SHR   last, #3
          ADD   last, t
        END
        CALL    largest
        MOV     top, #255
        SUB     top, most
        MOV     value, last
        CALL    largest
        CMP     top, #255
        WHERE   EQ
          MOV   most, #255
        END
        ADD     top, most
        RCR     top
        OUT     0, top
        JMP     frame

largest:
        MOV     most, #0
        .rept 8, bit
          SHL   value, #1
          JNONE CS, .clear
          SBC   t, t
          AND   value, t
          OR    most, #0x80 >> bit
.clear:
        .endr
        RET
