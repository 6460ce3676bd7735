; digits.s - which digit is it? A network of two layers over counts of edges
;
; With correlated double sampling. A bright digit on dark is read, 50 pixels high or so. Means of
; 2 x 2 pixels become cells of 4 bits, less the least one of the frame; the picture moves until the
; centre of mass of its bright cells is in the middle of the frame; four kernels of 3 x 3 cells find edges, and every NP counts those in
; eight directions. Each neuron adds all counts of all NPs with weights of +1 or -1. The sums flow
; through the array as a wave: in every step each NP takes what the NPs north and west of it had
; one step before, and adds its own part of a neuron that is one further back than theirs. So the
; last NP has the whole sum of another neuron in every step. What of it is above zero goes to all
; NPs bit by bit, by the global OR, and each column of NPs adds it up for one class.
;
; The weights lie in the NPs' memories from WEIGHTS on, as `npchip network train digits` writes them:
; for each step of the wave a byte of eight weights; NEURONS / 8 weights of the NP's class; the first
; count; two bytes of bias. With other weights it reads other signs.
;
; Outputs   digit     scalar   the class with the largest score, of equals the first; 255 if
;                              another one is within SURE of it
;           low       plane    scores of the classes 0 to 9 in the last row: low byte ...
;           high      plane    ... and high byte, in two's complement
; Constants DARK      1 for dark on bright, 0 if not defined
;           SURE      0 to 65535, 0 if not defined: then there is always an answer
;           NEURONS   a multiple of 8 up to 96, 80 if not defined
; Geometry  8 x 10 NPs: the weights are for them
; Words     469
; Cycles    10,539 to 11,250 per frame (default), 14,884 to 16,023 (conservative)
;           11,000 to 14,000 and 16,000 to 20,000 for a digit: the more activations, the more
; Thesis    3.2.1: convolutional networks, left to the future; npchip.vision.networks

; Tests     npchip test asm/digits.s
;
; run: digits frames=../examples/clips/digits_drawn.npy machine=default,conservative
; expect: digit[0..9] == 0, 1, 2, 3, 4, 5, 6, 7, 8, 9
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.require NP_ROWS == 8,  "the weights are for 8 rows of NPs"
.require NP_COLS == 10, "each column of NPs is a class"

.equ NEURONS, 80
.require NEURONS % 8 == 0, "every row of NPs has the weights of as many neurons"
.require NEURONS <= 96,    "an NP's memory holds the weights of 96 neurons beside the samples"
.equ DARK,    0
.equ SURE,    0
.equ NONE,    255               ; sent if it is not sure
.equ INK,     4                 ; least value of a cell that counts for the middle
.equ EDGE,    10                ; least difference across an edge

.output digit, 0, scalar
.output low,   1, plane
.output high,  2, plane
.budget words  469 + 3 * DARK
.budget cycles 26938          ; ink in a corner alone, and all activations at their largest

.equ SIGNAL,  0                 ; banks of the NP's memory
.equ RESET,   64
.equ CELL,    0                 ; cell (y, x) at 8*y + x
.equ NEAR,    64                ; the same with the cells next to the NP's: rows and columns -1 to 4
.equ COUNT,   32                ; eight counts
.equ WEIGHTS, 128
.equ START,   WEIGHTS + NEURONS + LAST + NEURONS / 8
.equ BIAS,    START + 1

.memory WEIGHTS, "digits.npy"

.equ LAST,    NP_ROWS + NP_COLS - 2     ; steps from the first NP to the last one
.equ UNIT,    6                         ; bits of a neuron's sum below its activation
.equ ZERO,    NP_ROWS * NP_COLS * 128 >> UNIT

.reg corner,  r0                ; 255 in the last NP, 0 elsewhere
.reg at,      r1                ; 8*y + x of a cell
.reg s,       r2                ; short-lived
.reg t,       r3

.reg lo,      r4                ; (capture, middle) 16 bits
.reg hi,      r5
.reg rows,    r6                ; sum of the rows of ink, in 16 bits
.reg rowsh,   r7
.reg cols,    r8                ; and of its columns
.reg colsh,   r9
.reg ink,     r10               ; number of cells of ink
.reg inkh,    r11
.reg row,     r12               ; 4 + the row of a cell in the frame
.reg col,     r13               ; its column
.reg least,   r14               ; least cell
.reg ground,  r15               ; what the frame has everywhere
.reg step,    r12               ; (middle) what 8*y + x changes by
.reg u,       r14
.reg v,       r15

.reg sum,     r4                ; (edges) + 128
.reg c,       r5
.reg high,    r6                ; the largest sum that is no edge
.reg c0,      r7                ; the cells around one, row by row
.reg c1,      r8
.reg c2,      r9
.reg c3,      r10
.reg c5,      r11
.reg c6,      r12
.reg c7,      r13
.reg c8,      r14

.reg less,    r2                ; (neurons)
.reg mine,    r6                ; the NP's row
.reg pass,    r7                ; steps of the wave
.reg p,       r8                ; a neuron's sum in the NPs of this column so far, in 16 bits
.reg ph,      r9
.reg q,       r10               ; and in all columns up to this one
.reg qh,      r11
.reg active,  r1                ; activation
.reg next,    r4                ; address of a class's weight
.reg w,       r12               ; weights; then that of a class, in 16 bits
.reg wh,      r13
.reg score,   r14
.reg scoreh,  r15

.reg own,     r6                ; (answer) 255 - column in the last row, 0 elsewhere
.reg order,   r7
.reg best,    r8
.reg bits,    r9
.reg first,   r10

; at := the next cell of this NP; goes to again, or on after the last one
.macro each again
        ADD     at, #1
        MOV     t, at
        AND     t, #4
        JANY    EQ, again
        ADD     at, #4
        CMP     at, #32
        JANY    LO, again
.endm

; One edge: counts where sum is EDGE or more at address, and -EDGE or less at the next one.
.macro tally address
        CMP     high, sum
        LD      c, [address]
        ADC     c, #0
        ST      [address], c
        CMP     sum, #128 - EDGE + 1
        LD      c, [address + 1]
        ADC     c, #0
        ST      [address + 1], c
.endm

; sum := 128 + the three cells beyond an edge - the three before it
.macro edge a, b, d, e, f, g, address
        MOV     sum, #128
        ADD     sum, a
        ADD     sum, b
        ADD     sum, d
        SUB     sum, e
        SUB     sum, f
        SUB     sum, g
        tally   address
.endm

; Moves by one cell if that brings the ink nearer to the middle: a is the ink's distance from the
; middle times the ink, which a cell changes by the ink.
.macro nearer a, ah, cell
        CMP     ah, #0x80
        JANY    HS, .back
        MOV     t, ink
        SUB     t, a
        MOV     t, inkh
        SBC     t, ah
        JNONE   LO, .done
        SUB     a, ink
        SBC     ah, inkh
        ADD     step, #cell
        JMP     .done
.back:  ADD     a, ink
        ADC     ah, inkh
        SUB     step, #cell
.done:
.endm

        ROW     t
        COL     s
        ADD     t, s
        MOV     s, #LAST - 1
        CMP     s, t
        SBC     corner, corner

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     ink, #0
        MOV     inkh, #0
        MOV     rows, #0
        MOV     rowsh, #0
        MOV     cols, #0
        MOV     colsh, #0
        ROW     row
        ADD     row, #1
        SHL     row, #2
        COL     col
        SHL     col, #2
        MOV     least, #15
        MOV     at, #0
.cell:  MOV     s, at           ; its first pixel
        ADD     s, s
        MOV     lo, #0
        MOV     hi, #0
        .rept   2
          .rept 2
          LD    t, [s + SIGNAL]
          ADD   lo, t
          ADC   hi, #0
          LD    t, [s + RESET]
          SUB   lo, t
          SBC   hi, #0
          ADD   s, #1
          .endr
        ADD     s, #6
        .endr
        SHL     hi, #2
        SHR     lo, #6
        OR      lo, hi
        CMP     lo, #16
        WHERE   HS              ; noise may be below 0
          MOV   lo, #0
        END
        .rept   DARK
        MOV     t, #15
        SUB     t, lo
        MOV     lo, t
        .endr
        ST      [at + CELL], lo ; over samples that have been read
        CMP     lo, least
        WHERE   LO
          MOV   least, lo
        END
        each    .cell

        MOV     ground, #0      ; the least cell of the frame
        .loop   1, 16
.level: CMP     least, #0
        JANY    EQ, .found
        SUB     least, #1
        ADD     ground, #1
        JMP     .level
.found: MOV     at, #0
.ink:   LD      t, [at + CELL]
        SUB     t, ground
        ST      [at + CELL], t
        CMP     t, #INK
        WHERE   HS
          ADD   ink, #1
          ADD   rows, row
          ADC   rowsh, #0
          ADD   cols, col
          ADC   colsh, #0
        END
        ADD     col, #1
        ADD     at, #1
        MOV     t, at
        AND     t, #4
        JANY    EQ, .ink
        SUB     col, #4
        ADD     row, #1
        ADD     at, #4
        CMP     at, #32
        JANY    LO, .ink

; ---- the middle

        MOV     lo, rows
        MOV     hi, rowsh
        CALL    total
        MOV     rows, lo
        MOV     rowsh, hi
        MOV     lo, cols
        MOV     hi, colsh
        CALL    total
        MOV     cols, lo
        MOV     colsh, hi
        MOV     lo, ink
        MOV     hi, inkh
        CALL    total
        MOV     ink, lo
        MOV     inkh, hi
        MOV     t, #COLS / 4 - 1
.from:  SUB     rows, ink       ; from the middle
        SBC     rowsh, inkh
        SUB     cols, ink
        SBC     colsh, inkh
        SUB     t, #1
        JANY    NE, .from

        .loop   1, COLS / 4 + 1
around: MOV     at, #0          ; the cells with those next to them
.own:   LD      t, [at + CELL]
        ST      [at + NEAR], t
        ADD     at, #1
        CMP     at, #28
        JANY    LO, .own
        MOV     at, #24
.rows:  LD      t, [at + NEAR]
        NBR     t, t, north
        SUB     at, #32
        ST      [at + NEAR], t
        ADD     at, #8
        LD      t, [at + NEAR]
        NBR     t, t, south
        ADD     at, #32
        ST      [at + NEAR], t
        SUB     at, #7
        CMP     at, #28
        JANY    LO, .rows
        MOV     at, #-5
.cols:  LD      t, [at + NEAR]
        NBR     t, t, west
        SUB     at, #4
        ST      [at + NEAR], t
        ADD     at, #1
        LD      t, [at + NEAR]
        NBR     t, t, east
        ADD     at, #4
        ST      [at + NEAR], t
        ADD     at, #7
        CMP     at, #43
        JANY    NE, .cols

        MOV     step, #0
        nearer  rows, rowsh, 8
        nearer  cols, colsh, 1
        CMP     step, #0
        JNONE   NE, edges
        MOV     at, #0
.move:  MOV     s, at
        ADD     s, step
        LD      t, [s + NEAR]
        ST      [at + CELL], t
        each    .move
        JMP     around

; ---- edges

edges:  LD      t, [START]
        MOV     at, #COUNT
.clear: ST      [at], t
        ADD     at, #1
        CMP     at, #COUNT + 8
        JANY    LO, .clear
        MOV     high, #128 + EDGE - 1
        MOV     at, #0
.cell:  MOV     s, at
        SUB     s, #9
        LD      c0, [s + NEAR]
        ADD     s, #1
        LD      c1, [s + NEAR]
        ADD     s, #1
        LD      c2, [s + NEAR]
        ADD     s, #6
        LD      c3, [s + NEAR]
        ADD     s, #2
        LD      c5, [s + NEAR]
        ADD     s, #6
        LD      c6, [s + NEAR]
        ADD     s, #1
        LD      c7, [s + NEAR]
        ADD     s, #1
        LD      c8, [s + NEAR]
        edge    c6, c7, c8, c0, c1, c2, COUNT
        edge    c2, c5, c8, c0, c3, c6, COUNT + 2
        edge    c5, c7, c8, c0, c1, c3, COUNT + 4
        edge    c3, c6, c7, c1, c2, c5, COUNT + 6
        each    .cell

; ---- neurons and classes

        MOV     less, #128      ; 128 - the sum of all counts
        MOV     at, #COUNT
.count: LD      c, [at]
        SUB     less, c
        ADD     c, c
        ST      [at], c
        ADD     at, #1
        CMP     at, #COUNT + 8
        JANY    LO, .count
        ROW     mine
        LD      score, [BIAS]
        LD      scoreh, [BIAS + 1]
        MOV     pass, #0
.step:  LD      w, [pass + WEIGHTS]
        MOV     sum, less       ; 128 + counts with +1 - counts with -1, modulo 256
        .rept   8, k
        SHR     w, #1
        SBC     t, t
        LD      c, [COUNT + k]
        AND     t, c
        ADD     sum, t
        .endr
        NBR     p, p, north
        NBR     ph, ph, north
        ADD     p, sum
        ADC     ph, #0
        NBR     q, q, west
        NBR     qh, qh, west
        ADD     q, p
        ADC     qh, ph
        CMP     pass, #LAST
        JANY    LO, .next       ; no neuron has come to the last NP
        MOV     active, qh
        SHL     active, #8 - UNIT
        MOV     t, q
        SHR     t, #UNIT
        OR      active, t
        SUB     active, #ZERO
        WHERE   LO
          MOV   active, #0
        END
        AND     active, corner
        JNONE   NE, .next
        MOV     next, pass
        SHR     next, #3          ; eight neurons take the same weight, ...
        ADD     next, #NEURONS + LAST - LAST / 8
        MOV     t, pass
        AND     t, #7
        MOV     w, #0
        CMP     t, mine         ; ... each in another row
        WHERE   EQ
          LD    w, [next + WEIGHTS]
        END
        MOV     wh, w
        ADD     wh, wh
        SBC     wh, wh
        .loop   1, 7
.bit:   SHR     active, #1
        JNONE   CS, .twice
        ADD     score, w
        ADC     scoreh, wh
.twice: ADD     w, w
        ADC     wh, wh
        CMP     active, #0
        JANY    NE, .bit
.next:  ADD     pass, #1
        CMP     pass, #LAST + NEURONS
        JANY    LO, .step

; ---- the answer

        MOV     lo, score
        MOV     hi, scoreh
        CALL    down
        COL     t
        MOV     own, #255
        SUB     own, t
        ROW     t
        CMP     t, #NP_ROWS - 1
        WHERE   EQ
          OUT   1, lo
          OUT   2, hi
          ADD   hi, #0x80       ; the least score becomes 0
        ELSE
          MOV   lo, #0
          MOV   hi, #0
          MOV   own, #0
        END
        MOV     score, lo
        MOV     scoreh, hi
        CALL    largest
        MOV     first, best
        MOV     lo, score       ; is it the largest if it is less by SURE?
        MOV     hi, scoreh
        CMP     own, first
        WHERE   EQ
          SUB   lo, #SURE & 255
          SBC   hi, #SURE >> 8
        END
        CALL    largest
        MOV     t, #255
        SUB     t, best
        CMP     best, first
        WHERE   NE
          MOV   t, #NONE
        END
        OUT     0, t
        JMP     frame

; best := the own of the NP with the largest hi:lo, of equals the largest. From the highest bit
; down, the global OR tells whether any NP that is still in has the bit. Changes lo, hi and t.
largest:
        MOV     order, own
        MOV     best, #0        ; the last eight bits of hi:lo:order
        MOV     bits, #24
.bit:   ADD     best, best
        ADD     order, order
        ADC     lo, lo
        ADC     hi, hi
        JNONE   CS, .none
        SBC     t, t            ; NPs without the bit are out
        AND     order, t
        AND     lo, t
        AND     hi, t
        ADD     best, #1
.none:  SUB     bits, #1
        JANY    NE, .bit
        RET

; hi:lo := the sum over all NPs, in the last one; 0 elsewhere. Changes u, v and t.
total:  CALL    down
        MOV     u, lo
        MOV     v, hi
        MOV     t, #NP_COLS - 1
.right: NBR     u, u, west
        NBR     v, v, west
        ADD     lo, u
        ADC     hi, v
        SUB     t, #1
        JANY    NE, .right
        AND     lo, corner
        AND     hi, corner
        RET

; hi:lo := in the last row the sum over the NPs of a column. Changes u, v and t.
down:   MOV     u, lo
        MOV     v, hi
        MOV     t, #NP_ROWS - 1
.down:  NBR     u, u, north
        NBR     v, v, north
        ADD     lo, u
        ADC     hi, v
        SUB     t, #1
        JANY    NE, .down
        RET
