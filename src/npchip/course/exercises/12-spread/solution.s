; solution.s - NPs at or beside something dark
;
; A better one needs the four NBR as well, but not the mask in the loop: after CMP, `SBC t, t` is
; 255 where the pixel is dark, and `OR mine, t` collects it. One cycle less a pixel.
;
; expect: words <= 28
; expect: cycles <= 860 points=2
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: near == null ; nothing is sent yet: OUT 0, near behind the loop and the four neighbours
; run: steps levels=100,99,100
; expect: near == 0, 255, 0
; mistake: near[0] == 255 ; a pixel of 100 is not darker than 100: LO, not LS
; mistake: near[2] == 255 ; what an earlier frame had is kept: begin with 0 in every frame
; run: alone frames=mouse_run first=1
; expect: near[0][5, 4] == 255
; mistake: near[0][5, 4] == 0 ; an NP with a dark pixel of its own counts too: near begins with a copy of mine
; run: drawn frames=shapes_drawn
; expect: near[3][0, 4] == 255
; expect: sum(near[0]) == 12750 points=2
; expect: sum(near[1]) == 15300
; expect: sum(near[3]) == 14280 points=2
; mistake: sum(near[1]) == 9180 ; these are the NPs with dark pixels alone: their neighbours belong to them
; mistake: near[1][7, 1] == 255 ; it spreads round corners: read all four neighbours from mine, collect in near
; mistake: sum(near[1]) == 13770 ; one of the four neighbours is missing
; run: mouse frames=mouse_run first=30
; expect: golden outputs points=3
; run: coin frames=coin_slide
; expect: golden outputs

.output near, 0, plane
.reg pixel, r0
.reg value, r1
.reg mine, r2
.reg near, r3
.reg t, r4
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     mine, #0
        MOV     pixel, #0
.next:  LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   mine, #255
        END
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .next
        MOV     near, mine
        NBR     t, mine, north
        OR      near, t
        NBR     t, mine, east
        OR      near, t
        NBR     t, mine, south
        OR      near, t
        NBR     t, mine, west
        OR      near, t
        OUT     0, near
        JMP     frame
