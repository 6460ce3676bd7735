; solution.s - how many pixels are dark
;
; A better one would count with the carry, as in `count`, and walk with loops if words are short.
; Several sums cost little more than one, as they share the walk: asm/statistics.s of npchip adds up
; 19.
;
; expect: words <= 94
; expect: cycles <= 880 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: error == NP311 ; a scalar16 takes two sends a frame, the low byte and the high one
; mistake: error == NP310 ; only the NP at the lower right has the sum: the others must be switched off when it is sent
; mistake: dark == null ; nothing is sent yet: two bytes, the low one first, in the last NP
; run: steps levels=100,99,100
; expect: dark == 0, 5120, 0 points=2
; mistake: dark[1] == 0 ; only the low byte is added up: 5,120 is 20 times 256 and 0, so ADC must go on in the high one
; mistake: dark[1] == 1024 ; carries along the rows are lost: ADC high, #0 after each ADD
; mistake: dark[1] == 20 ; the bytes are exchanged: the low one is sent first
; mistake: dark[1] == 80 ; these are NPs, not pixels: count all pixels
; mistake: dark[0] != 0 ; a pixel of 100 is not darker than 100: LO, not LS
; mistake: dark[2] != 0 ; what an earlier frame had is kept: begin with 0 in every frame
; run: drawn frames=shapes_drawn
; expect: dark[0] == 1156 points=2
; expect: dark[3] == 1608
; run: mouse frames=mouse_run
; expect: golden outputs points=3
; run: coin frames=coin_slide
; expect: golden outputs

.output dark, 0, scalar16
.reg pixel, r0
.reg value, r1
.reg low, r2
.reg high, r3
.reg t, r4
.reg th, r5
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     low, #0
        MOV     high, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          ADD   low, #1
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     t, low
        .rept NP_COLS - 1
          NBR   t, t, west
          ADD   low, t
          ADC   high, #0
        .endr
        MOV     t, low
        MOV     th, high
        .rept NP_ROWS - 1
          NBR   t, t, north
          NBR   th, th, north
          ADD   low, t
          ADC   high, th
        .endr
        ROW     t
        CMP     t, #NP_ROWS - 1
        WHERE   EQ
          COL   t
          CMP   t, #NP_COLS - 1
          WHERE EQ
            OUT 0, low
            OUT 0, high
          END
        END
        JMP     frame
