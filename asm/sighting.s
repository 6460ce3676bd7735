; sighting.s - where an object is, for the other camera
;
; What tracking.s finds of an object's place and no more, in half pixels, so that the partner of a
; rig of two cameras (fusion_lut.s) or a separate processor has it as soon as it is known.
;
; Outputs   seen        scalar  1 where there is an object; else all outputs are 0
;           twice_row   scalar  top + bottom of its box: twice the centre's row
;           twice_col   scalar  left + right: twice the centre's column
; Constants THRESHOLD   1 to 255, 128 if not defined
;           DARK        0 or 1, 0 if not defined; see tracking.s
; Geometry  up to 16 x 16 NPs
; Words     185
; Cycles    1,372 per frame (default), 2,184 (conservative) on coin_slide;
;           up to 1,375 and 2,187, and 24 more with DARK
; Thesis    1.3: object tracking; 2.1.1: centre of an object

; Tests     npchip test asm/sighting.s
;
; run: levels levels=127,128,255
; expect: seen == 0, 1, 1
; expect: twice_row == 0, 63, 63
; expect: twice_col == 0, 79, 79
; run: dark   frames=../examples/clips/shapes_photo.npy define=DARK=1 define=THRESHOLD=64
; expect: seen == 1
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.require NP_ROWS <= 16, "twice the number of a row of pixels has 8 bits"
.require NP_COLS <= 16, "twice the number of a column of pixels has 8 bits"

.equ THRESHOLD, 128
.equ DARK,      0

.output seen,      0, scalar
.output twice_row, 1, scalar
.output twice_col, 2, scalar
.budget words  185 + 3 * DARK
.budget cycles 1375 + 24 * DARK ; a box from row and column 0 to 63

.include "lib/object_registers.s"

frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, nothing
        CALL    centre
        MOV     t, #1
        OUT     0, t
        OUT     1, row
        OUT     2, col
        JMP     frame

nothing:
        MOV     t, #0
        .rept 3, port
        OUT     port, t
        .endr
        JMP     frame

.include "lib/object_box.s"
