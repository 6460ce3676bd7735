; orientation.s - how far away is the camera? Key points of a triangle, and a neural network
;
; With correlated double sampling. The picture shows a right triangle, one corner of it brighter
; than the rest, from a camera that looks at its centroid. The program finds the corners (the
; farthest points of lib/farthest_points.s), puts them into the order of the picture, anticlockwise
; from the one that is nearest to the brightest pixel, and measures the sides in half pixels. Then
; every NP is a neuron: it adds three products of a side and a weight of its own to a bias, clamps
; the sum, and multiplies it by one more weight. The sum over the whole array is the distance from
; the camera to the centroid. With compass and pitch, which a drone has, that is its position.
;
; There is no multiplication: products are made of shifts and additions. There is no root: as many
; odd numbers can be taken away from a square as its root says.
;
; The weights are written into the NPs before the run, --memory 208=FILE.npy, uint8 of shape
; (8, NP rows, NP columns): three weights of the sides, -63 to 63; bias, low and high byte; weight
; of the neuron; offset, low and high byte, in one NP. All are 0 where an NP is no neuron.
; npchip orient train --model chip --memory FILE.npy makes them.
;
; Outputs   count     scalar    3; 0 without an object
;           vertices  list      row and column of each corner, the highlighted one first
;           sides     list      length of each side in half pixels, at most 255, from there on
;           distance  scalar16  from the camera to the centroid, in mm
; Constants THRESHOLD 1 to 255, 44 if not defined
; Geometry  rows and columns together up to 256
; Words     395
; Cycles    11,916 to 11,928 per frame (default), 17,265 to 17,277 (conservative)
;           with the triangle 9,021 to 10,167 (12,581 to 14,425); on 13 x 13 NPs, with
;           100 x 100 pixels, 9,480 to 10,527
; Thesis    3.4.6 and 4.1.2; npchip.vision.orientation: corners, eightbit

; Tests     npchip test asm/orientation.s
;
; run: thesis frames=../examples/orientation/frames-100x100.npy machine=../examples/orientation/uav.yaml memory=208=../examples/orientation/weights-100x100.npy
; expect: golden
; run: chip   frames=../examples/orientation/frames-64x80.npy machine=default,conservative memory=208=../examples/orientation/weights-64x80.npy
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative memory=208=../examples/orientation/weights-64x80.npy
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative memory=208=../examples/orientation/weights-64x80.npy
; expect: golden cycles

.require ROWS + COLS <= 256, "the two legs of a side have 8 bits together"

.equ THRESHOLD, 44
.equ SEARCHES,  6

.equ DARK,      0               ; a dark object could have no brightest corner
.if DARK
.error "the object has to be bright: its highlighted corner is the brightest of the frame"
.endif

.output count,    0, scalar
.output vertices, 1, list
.output sides,    2, list
.output distance, 3, scalar16
.budget words  395
.budget cycles 12200            ; no triangle in 64 x 80 pixels has sides of more than 486 halves

.equ BRIGHTEST, RIGHT + 6       ; place of the brightest pixel, in variables of the library
.equ SIDE_OF,   FIRST           ; sides, in [CORNERS + SIDE_OF] and on
.equ WEIGHT_OF, HIGH            ; what the host has written, in [CORNERS + WEIGHT_OF] and on
.equ BIAS,      WEIGHT_OF + CORNERS + 3
.equ OUT_OF,    CORNERS + 5     ; the neuron's weight, in [OUT_OF + WEIGHT_OF]
.equ OFFSET,    WEIGHT_OF + CORNERS + 6
.equ SHIFT,     4               ; bits of a sum below the neuron's output
.equ FRACTION,  3               ; bits of the distance below a millimetre

.include "lib/farthest_points.s"

.reg second, r0                 ; places of B and C among the corners
.reg third,  r1
.reg v,      r0                 ; a corner
.reg number, r7                 ; a side, an input
.reg least,  r8                 ; smallest distance from the brightest pixel
.reg nearest, r9                ; the corner that has it
.reg far,    r10

; Adds |a - b| to far. Changes t and a.
.macro distance a, b
        SUB     a, b
        WHERE   LO
          MOV   t, #0
          SUB   t, a
          MOV   a, t
        END
        ADD     far, a
.endm

; Which way round? The cross product (B - A) x (C - A) = down * next right - right * next down
        LD      row, [CORNERS + ROW_OF]
        LD      col, [CORNERS + COL_OF]
        MOV     g, #0
        MOV     G, #0
        MOV     w, qcol
        SUB     w, col
        SBC     W, W
        MOV     u, prow
        SUB     u, row
        CALL    product
        MOV     w, col
        SUB     w, pcol
        SBC     W, W
        MOV     u, qrow
        SUB     u, row
        CALL    product
        MOV     second, #CORNERS + 1
        MOV     third, #CORNERS + 2
        CMP     G, #0x80
        WHERE   HS              ; negative: clockwise
          MOV   second, #CORNERS + 2
          MOV   third, #CORNERS + 1
        END
        ST      [second + ROW_OF], prow
        ST      [second + COL_OF], pcol
        ST      [third + ROW_OF], qrow
        ST      [third + COL_OF], qcol

        MOV     v, #CORNERS     ; the highlighted corner
        MOV     least, #255
.near:  MOV     far, #0
        LD      g, [v + ROW_OF]
        LD      w, [BRIGHTEST]
        distance g, w
        LD      g, [v + COL_OF]
        LD      w, [BRIGHTEST + 1]
        distance g, w
        CMP     far, least
        WHERE   LO
          MOV   least, far
          MOV   nearest, v
        END
        ADD     v, #1
        CMP     v, #CORNERS + 3
        JANY    LO, .near

        MOV     v, nearest
        MOV     number, #CORNERS
.side:  LD      prow, [v + ROW_OF]
        LD      pcol, [v + COL_OF]
        OUT     1, prow
        OUT     1, pcol
        ADD     v, #1
        CMP     v, #CORNERS + 3
        JANY    LO, .other
        MOV     v, #CORNERS
.other: LD      qrow, [v + ROW_OF]
        LD      qcol, [v + COL_OF]
        MOV     g, #0
        MOV     G, #0
        SUB     qrow, prow
        MOV     w, qrow
        CALL    square
        SUB     qcol, pcol
        MOV     w, qcol
        CALL    square
        CMP     G, #0x40
        MOV     w, #1           ; the first odd number
        MOV     W, #0
        JANY    HS, .long       ; four squares need more than 16 bits
        .rept 2
        ADD     g, g
        ADC     G, G
        .endr
        .loop   256             ; odd numbers up to 511
.root:  SUB     g, w
        SBC     G, W
        JANY    LO, .done
        ADD     w, #2
        ADC     W, #0
        JMP     .root
.long:  MOV     w, #255         ; twice 255
        MOV     W, #1
.done:  SHR     W, #1           ; half of the odd number: how many there were
        RCR     w
        ST      [number + SIDE_OF], w
        OUT     2, w
        ADD     number, #1
        CMP     number, #CORNERS + 3
        JANY    LO, .side

        LD      g, [BIAS]       ; a neuron
        LD      G, [BIAS + 1]
        MOV     number, #CORNERS
.input: LD      u, [number + SIDE_OF]
        CALL    weigh
        ADD     number, #1
        CMP     number, #CORNERS + 3
        JANY    LO, .input
        ADD     G, #0x80 >> (8 - SHIFT)
        CMP     G, #1 << SHIFT
        WHERE   LO              ; between the clamps: bits 4 to 11
          SHL   G, #8 - SHIFT
          SHR   g, #SHIFT
          OR    G, g
        ELSE
          CMP   G, #0x80 + (0x80 >> (8 - SHIFT))
          SBC   G, G            ; 255 above them, 0 below
        END
        MOV     u, G
        LD      g, [OFFSET]
        LD      G, [OFFSET + 1]
        MOV     number, #OUT_OF
        CALL    weigh

        MOV     d, g            ; the sum of all NPs arrives in the first column ...
        MOV     D, G
        MOV     number, #NP_COLS - 1
.west:  NBR     d, d, east
        NBR     D, D, east
        ADD     g, d
        ADC     G, D
        SUB     number, #1
        JANY    NE, .west
        MOV     d, g            ; ... and in its first NP
        MOV     D, G
        MOV     number, #NP_ROWS - 1
.north: NBR     d, d, south
        NBR     D, D, south
        ADD     g, d
        ADC     G, D
        SUB     number, #1
        JANY    NE, .north
        ADD     g, #1 << (FRACTION - 1) ; to the nearest mm
        ADC     G, #0
        .rept FRACTION
        SHR     G, #1
        RCR     g
        .endr
        MOV     t, #3
        OUT     0, t
        ROW     t
        COL     u
        OR      t, u
        WHERE   EQ              ; the others have sums of parts
          OUT   3, g
          OUT   3, G
        END
        JMP     frame

nothing:
        MOV     t, #0
        OUT     0, t
        JMP     frame

; g:G := g:G + w². Takes w from a subtraction, C where it is negative. Changes u, w and W.
square: MOV     u, w
        SBC     W, W
        JMP     product

; g:G := g:G + u * weight `number` of this NP. Changes u, w and W.
weigh:  LD      w, [number + WEIGHT_OF]
        MOV     W, w
        SHL     W, #1
        SBC     W, W            ; its sign
        CMP     u, #0           ; u has none
        JMP     product

.include "lib/farthest_search.s"
