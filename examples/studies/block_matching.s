; block_matching.s - where has each block of the frame before gone? Block matching, +- 2 pixels
;
; With correlated double sampling. The block of an NP is its 8 x 8 pixels in the frame before. It is
; laid over the new frame at 5 x 5 places around its own, and the place with the smallest sum of
; absolute differences wins; of equals the first in the order of rows. Outside the frame pixels
; are 0. All 80 blocks are searched for at the same time.
;
; In the first frame the block before is all 0.
;
; Outputs   down    plane   rows from the block's place to the best one, two's complement
;           right   plane   columns, the same
;           low     plane   the smallest sum of absolute differences: low byte
;           high    plane   and high byte
; Words     305
; Cycles    22,246 per frame (default), 27,349 (conservative)
; Thesis    3.2.2: correlation of small blocks, which is too slow for the chip

; Tests     npchip test -I asm examples/studies/block_matching.s
;
; run: coin   frames=../clips/coin_slide.npy machine=default,conservative
; expect: status == frames-exhausted

.output down,  0, plane
.output right, 1, plane
.output low,   2, plane
.output high,  3, plane
.budget cycles 22246

.equ REACH,  2                  ; places in each direction
.equ WIDTH,  8 + 2 * REACH      ; of the window
.equ SIGNAL, 0                  ; banks of the NP's memory
.equ RESET,  128
.equ WINDOW, 0                  ; the new frame: pixel (y, x) at FIRST + WIDTH*y + x
.equ FIRST,  (WIDTH + 1) * REACH
.equ BEFORE, 192                ; the block: pixel (y, x) at 8*y + x

.reg p,      r0                 ; place in the block
.reg w,      r1                 ; place in the window
.reg f,      r2
.reg t,      r3
.reg low,    r4                 ; sum of absolute differences
.reg high,   r5
.reg least,  r6                 ; the smallest one
.reg leasth, r7
.reg start,  r8                 ; place of the block in the window
.reg down,   r9
.reg right,  r10
.reg best,   r11                ; down and right of the smallest one
.reg bestr,  r12
.reg b,      r13

.include "lib/cds.s"

; low:high := low:high + |f - b|
.macro add_difference
        SUB     f, b
        WHERE   LO
          MOV   t, #0
          SUB   t, f
          MOV   f, t
        END
        ADD     low, f
        ADC     high, #0
.endm

; Takes what the neighbour has at place w of its window to the place `far` further on, and goes on
; by `step`. Changes p and t.
.macro copy side, far, step
        LD      t, [w + WINDOW]
        NBR     t, t, side
        MOV     p, w
        ADD     p, #far
        ST      [p + WINDOW], t
        ADD     w, #step
.endm

frame:  EXPOSE
        MOV     p, #0           ; the block is that of the frame before
        MOV     w, #FIRST
.keep:  .rept 8
        LD      f, [w + WINDOW]
        ST      [p + BEFORE], f
        ADD     p, #1
        ADD     w, #1
        .endr
        ADD     w, #2 * REACH
        CMP     p, #64
        JANY    LO, .keep
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL

        MOV     p, #63          ; the pixels into the window, from the last one on
        MOV     w, #FIRST + 7 * WIDTH + 7
.row:   .rept 8
        cds     f, p, t
        ST      [w + WINDOW], f ; over samples that have been read
        SUB     p, #1
        SUB     w, #1
        .endr
        SUB     w, #2 * REACH
        CMP     p, #255
        JANY    NE, .row

        MOV     w, #FIRST       ; its margin: the rows of the NPs north and south ...
.above: .rept REACH
        copy    south, 8 * WIDTH, WIDTH
        .endr
        ADD     w, #(8 - 2 * REACH) * WIDTH
        .rept REACH
        copy    north, 0 - 8 * WIDTH, WIDTH
        .endr
        SUB     w, #8 * WIDTH - 1 ; the next column
        CMP     w, #FIRST + 8
        JANY    LO, .above
        MOV     w, #REACH       ; ... and the columns of those west and east, with the corners
.side:  .rept REACH
        copy    east, 8, 1
        .endr
        ADD     w, #8 - 2 * REACH
        .rept REACH
        copy    west, 0 - 8, 1
        .endr
        ADD     w, #WIDTH - 8
        CMP     w, #WIDTH * WIDTH
        JANY    LO, .side

        MOV     least, #255     ; more than any sum
        MOV     leasth, #255
        MOV     start, #0
        MOV     down, #0 - REACH
.down:  MOV     right, #0 - REACH
.right: MOV     low, #0
        MOV     high, #0
        MOV     p, #0
        MOV     w, start
.line:  .rept 8
        LD      f, [w + WINDOW]
        LD      b, [p + BEFORE]
        add_difference
        ADD     p, #1
        ADD     w, #1
        .endr
        ADD     w, #2 * REACH
        CMP     p, #64
        JANY    LO, .line
        CMP     low, least
        MOV     t, high
        SBC     t, leasth
        WHERE   LO
          MOV   least, low
          MOV   leasth, high
          MOV   best, down
          MOV   bestr, right
        END
        ADD     start, #1
        ADD     right, #1
        CMP     right, #REACH + 1
        JANY    NE, .right
        ADD     start, #8 - 1
        ADD     down, #1
        CMP     down, #REACH + 1
        JANY    NE, .down
        OUT     0, best
        OUT     1, bestr
        OUT     2, least
        OUT     3, leasth

        JMP     frame
