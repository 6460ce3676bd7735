; recognise.s - which triangle is it? Key points, side lengths, comparison with references
;
; With correlated double sampling. The key points of all objects are found with the tracers of
; lib/edge_tracer.s. An object with three of them is a triangle. The lengths of its sides do not
; change with shift and rotation; scaled so that the longest is 128 they do not change with size.
; Then every NP compares them with a reference of its own, so that 80 cost as much as one. The
; difference is the largest one of the three sides, in the best of the three rotations.
;
; A side over y rows and x columns, or the other way round with y the larger number, is
; max(y, y - y/8 + x/2) long, or with SHIFTS defined as 0 y + round(x/3), as the thesis has it.
;
; References are written into the NPs before the run, --memory 176=FILE.npy: three scaled sides of
; each, clockwise, uint8 of shape (3, 8, 10), 0 where an NP has none. With no reference at all, every
; NP has SIDE_0, SIDE_1, SIDE_2.
;
; Outputs   objects   scalar   number of traced objects, at most 255
;           count     list     key points of each object, at most 32
;           sides     list     scaled sides of each triangle, from its first key point on
;           match     list     for each object the NP whose reference is most like it, 10 * row +
;                              column, the first of equals; 255 if it is no triangle, or none is
;           distance  list     for each object the difference from it; 255 if it is no triangle
; Constants THRESHOLD 1 to 255, 128 if not defined
;           DARK      0 or 1, 0 if not defined
;           SHORTEST  steps of a trace that counts as an object, 1 to 255, 8 if not defined
;           MERGE     rows and columns within which corners are the same, 0 to 127, 3 if not defined
;           SHIFTS    how lengths are computed, 1 if not defined
;           TOLERANCE largest difference of a match, 0 to 128, 8 if not defined
;           SIDE_0, SIDE_1, SIDE_2   128, 83, 96 if not defined
; Geometry  up to 11 x 11 NPs: lengths have seven bits
; Words     462
; Cycles    27,848 to 31,344 per frame (default), 43,604 to 49,060 (conservative)
;           about 600 for each triangle, whatever the number of references
; Thesis    3.3; npchip.vision.keypoints and npchip.vision.shapes

; Tests     npchip test asm/recognise.s
;
; run: photo  frames=../examples/clips/shapes_photo.npy machine=default,conservative define=THRESHOLD=190
; expect: count[0] == [3, 4, 4]     ; the triangle, the kite and the rectangle
; expect: match[0] == [0, 255, 255]
; expect: count[1] == [4]           ; the quadrilateral
; expect: match[1] == [255]
; expect: golden
; run: other  frames=../examples/clips/shapes_photo.npy define=THRESHOLD=190 define=SIDE_1=128
; expect: match[0] == [255, 255, 255]
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative define=DARK=1
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.require NP_ROWS <= 11, "the length of a side has 7 bits"
.require NP_COLS <= 11, "the length of a side has 7 bits"

.equ THRESHOLD, 128
.equ DARK,      0
.equ SHORTEST,  8
.equ MERGE,     3
.equ SHIFTS,    1
.equ TOLERANCE, 8
.equ SIDE_0,    128
.equ SIDE_1,    83
.equ SIDE_2,    96

.output objects,  0, scalar
.output count,    1, list
.output sides,    2, list
.output match,    3, list
.output distance, 4, list
.budget words  462
.budget cycles 1208948          ; a grid of lines with holes of one pixel: 1,179 traces

.equ REFERENCE, BITS + 48       ; three sides
.equ NUMBER,    BITS + 51       ; of this NP
.equ LENGTH,    OBJECT          ; of side v - NONE, at v: the samples there have been read

.reg longest, r0
.reg long,    r1                ; legs of a side
.reg short,   r2
.reg side_0,  r0                ; (later) scaled sides
.reg side_1,  r1
.reg side_2,  r2
.reg l,       r3                ; a length
.reg scaled,  r4
.reg turns,   r4                ; (later)
.reg least,   r5                ; smallest difference of all rotations
.reg d,       r8
.reg value,   r9                ; (maximum)
.reg bit,     r10
.reg most,    r11

; t := |t - u|, up to 128. Coordinates are known only modulo 256, so the sign is bit 7. Changes u.
.macro size u
        SUB     t, u
        CMP     t, #128
        WHERE   HS
          MOV   u, t
          MOV   t, #0
          SUB   t, u
        END
.endm

; d := the larger one of d and |side - the NP's reference|
.macro differ side, address
        MOV     t, side
        LD      v, [address]
        size    v
        CMP     d, t
        WHERE   LO
          MOV   d, t
        END
.endm

        ROW     t               ; the number of this NP
        COL     v
        .loop   NP_ROWS
.count: CMP     t, #0
        WHERE   NE
          ADD   v, #NP_COLS
          SUB   t, #1
        END
        JANY    NE, .count
        ST      [NUMBER], v
        LD      t, [REFERENCE]  ; references?
        CMP     t, #0
        JANY    NE, start
        MOV     t, #SIDE_0
        ST      [REFERENCE], t
        MOV     t, #SIDE_1
        ST      [REFERENCE + 1], t
        MOV     t, #SIDE_2
        ST      [REFERENCE + 2], t
start:
.include "lib/edge_tracer.s"

; Compares an object.
object: MOV     t, points
        SUB     t, #NONE
        OUT     1, t
        MOV     least, #255
        CMP     t, #3
        JANY    NE, .other

        LD      t, [NONE + ROW_OF]
        ST      [NONE + 3 + ROW_OF], t ; the third side ends at the first point
        LD      t, [NONE + COL_OF]
        ST      [NONE + 3 + COL_OF], t
        MOV     longest, #0
        MOV     v, #NONE
.side:  LD      long, [v + ROW_OF]
        LD      short, [v + COL_OF]
        ADD     v, #1
        LD      t, [v + ROW_OF]
        size    long            ; rows ...
        MOV     long, t
        LD      t, [v + COL_OF]
        size    short           ; ... and columns
        MOV     short, t
        CMP     long, short
        WHERE   LO
          MOV   short, long
          MOV   long, t
        END
        .rept SHIFTS
        MOV     t, long
        SHR     t, #3
        MOV     l, long
        SUB     l, t
        SHR     short, #1
        ADD     l, short        ; y - y/8 + x/2, at least y
        CMP     l, long
        WHERE   LO
          MOV   l, long
        END
        .endr
        .rept 1 - SHIFTS
        MOV     l, long
        ADD     short, #1       ; y + (x + 1)/3
.third: SUB     short, #3
        JANY    LO, .whole
        ADD     l, #1
        JMP     .third
.whole:
        .endr
        ST      [v + LENGTH], l
        CMP     longest, l
        WHERE   LO
          MOV   longest, l
        END
        CMP     v, #NONE + 3
        JANY    LO, .side

        MOV     v, #NONE
.scale: ADD     v, #1           ; 128 * l / longest, bit by bit
        LD      l, [v + LENGTH]
        MOV     scaled, #1      ; a sentinel: falls out on the left after eight bits
.bit:   CMP     l, longest
        WHERE   HS
          SUB   l, longest
        END
        ADC     scaled, scaled  ; 0 where it was taken away
        JANY    CS, .bits
        ADD     l, l
        JMP     .bit
.bits:  MOV     t, #255
        SUB     t, scaled
        ST      [v + LENGTH], t
        OUT     2, t
        CMP     v, #NONE + 3
        JANY    LO, .scale

        LD      side_0, [NONE + 1 + LENGTH]
        LD      side_1, [NONE + 2 + LENGTH]
        LD      side_2, [NONE + 3 + LENGTH]
        MOV     turns, #3
.turn:  MOV     d, #0
        differ  side_0, REFERENCE
        differ  side_1, REFERENCE + 1
        differ  side_2, REFERENCE + 2
        CMP     d, least
        WHERE   LO
          MOV   least, d
        END
        MOV     t, side_0
        MOV     side_0, side_1
        MOV     side_1, side_2
        MOV     side_2, t
        SUB     turns, #1
        JANY    NE, .turn
        LD      t, [REFERENCE]
        CMP     t, #0
        WHERE   EQ              ; no reference
          MOV   least, #255
        END

.other: MOV     value, #255     ; the smallest difference of all NPs ...
        SUB     value, least
        CALL    maximum
        MOV     d, #255
        SUB     d, most
        LD      t, [NUMBER]     ; ... and the first NP that has it
        MOV     value, #255
        SUB     value, t
        CMP     least, d
        WHERE   NE
          MOV   value, #0
        END
        CALL    maximum
        MOV     t, #255
        SUB     t, most
        CMP     d, #TOLERANCE + 1
        WHERE   HS
          MOV   t, #255
        END
        OUT     3, t
        OUT     4, d
        RET

; most := the largest value of all NPs, in every NP. From the highest bit down, the global OR
; tells whether any NP that is still in has the bit; then those without it are out.
maximum:
        MOV     most, #0
        MOV     bit, #0x80
.next:  SHL     value, #1
        JNONE   CS, .clear
        SBC     t, t
        AND     value, t
        OR      most, bit
.clear: SHR     bit, #1
        JANY    NE, .next
        RET

done:   LD      t, [FOUND]
        OUT     0, t
        RET
