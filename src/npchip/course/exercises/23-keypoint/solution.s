; solution.s - the first dark pixel in reading order
;
; A better one would search once: row and column together are a number of 13 bits, and thirteen
; questions in two bytes need no second set of candidates. asm/keypoints.s of npchip walks along the
; edge of a shape and finds all its corners.
;
; expect: words <= 130
; expect: cycles <= 1050 points=2
; mistake: error == NP310 ; the NPs send different bytes: only JANY and JNONE tell the program what one of them has
; mistake: error == NP305 ; the program runs past its last word: JMP frame waits for the next picture
; mistake: error == NP020 ; a WHERE is open at a jump: END comes before it; a jump takes all NPs along, and JANY asks whether one fits
; mistake: status == cycle-limit ; a loop never ends: does its counter grow before it is compared, is it set back inside the loop, or does a JMP go back without a condition?
; mistake: col == null ; nothing is sent yet as col: row goes to port 0, col to port 1
; run: flat levels=255,50
; expect: row == 255, 0
; expect: col == 255, 0 points=2
; mistake: col[0] == 7 ; in an empty picture the column is 255 as well: NPs without a pixel take no part
; run: drawn frames=shapes_drawn
; expect: row == 8, 11, 6, 5 points=2
; expect: col == 38, 22, 37, 39 points=3
; mistake: col[1] == 19 ; that is the first column of all: only NPs with a pixel in that row take part
; mistake: col[1] <= 7 ; a column within its NP: add 8 times the number of the NP's column
; mistake: row[1] == 22 ; row and column are exchanged
; run: mouse frames=mouse_run
; expect: golden outputs points=3
; run: coin frames=coin_slide
; expect: golden outputs

.output row, 0, scalar
.output col, 1, scalar
.reg pixel, r0
.reg value, r1
.reg first, r2
.reg row, r3
.reg most, r4
.reg t, r5
.reg top, r6
.reg col, r7
frame:  EXPOSE
        SAMPLE  signal, 0
        MOV     first, #255
        MOV     pixel, #64
.next:  SUB     pixel, #1
        LD      value, [pixel]
        CMP     value, #100
        WHERE   LO
          MOV   first, pixel
        END
        CMP     pixel, #0
        JANY    NE, .next
        MOV     row, #255
        CMP     first, #255
        WHERE   NE
          ROW   row
          SHL   row, #3
          MOV   t, first
          SHR   t, #3
          ADD   row, t
        END
        MOV     value, #255
        SUB     value, row
        CALL    largest
        MOV     top, #255
        SUB     top, most
        OUT     0, top
        MOV     col, #255
        CMP     first, #255
        WHERE   NE
          CMP   row, top
          WHERE EQ
            COL col
            SHL col, #3
            AND first, #7
            ADD col, first
          END
        END
        MOV     value, #255
        SUB     value, col
        CALL    largest
        MOV     col, #255
        SUB     col, most
        OUT     1, col
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
