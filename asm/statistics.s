; statistics.s - minimum, maximum, mean and histogram of the whole frame
;
; With correlated double sampling. Every NP first sums up its own 64 pixels. Then the extremes are
; found with the global OR, and the sums flow through the array: a row of NPs adds up a table of
; numbers as a pipeline. Each number starts in the west as 0 and moves one NP to the east in each
; step; there it meets, through the address that every NP counts for itself, the number of the
; same kind. So all NPs of a row work on different numbers at the same time: TABLE + NP_COLS - 1
; steps instead of TABLE * (NP_COLS - 1). The last column then does the same from north to south,
; and the NP in the south-east corner holds the totals and sends them.
;
; Outputs   minimum     scalar   darkest pixel
;           maximum     scalar   brightest pixel
;           mean        scalar   sum / number of pixels, rounded half up
;           histogram   list     32 bytes: for each k from 0 to 15 the number of pixels with
;                                pixel >> 4 = k, low byte first
; Geometry  up to 1,023 NPs, at most 46 in a row or column
; Words     483
; Cycles    3,012 to 3,027 per frame (default), 4,702 to 4,717 (conservative) on coin_slide
; Thesis    1.3: statistical computation

; Tests     npchip test asm/statistics.s
;
; run: levels levels=0,100,255
; expect: minimum == 0, 100, 255
; expect: maximum == 0, 100, 255
; expect: mean == 0, 100, 255
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.require NP_ROWS <= 46, "a table and the steps of its flow share 64 bytes of an NP"
.require NP_COLS <= 46, "a table and the steps of its flow share 64 bytes of an NP"
.require ROWS * COLS < 1 << 16, "a count of pixels has 16 bits"

.output minimum,   0, scalar
.output maximum,   1, scalar
.output mean,      2, scalar
.output histogram, 3, list
.budget words  483
.budget cycles 3042             ; a frame with both 0 and 255 takes longest

.equ SIGNAL, 0                  ; banks of the NP's memory
.equ RESET,  64
.equ LOW,    128                ; the table: low bytes ...
.equ HIGH,   192                ; ... and high bytes of
.equ BINS,   16                 ; the histogram, and
.equ SUM,    BINS               ; the sum in three parts, so that 16 bits hold each one's total:
.equ TABLE,  BINS + 3           ; bits 0 to 3, 4 to 7 and 8 to 15
.equ PIXELS, ROWS * COLS

.reg pixel,   r0                ; 8*y + x, the same in every NP
.reg f,       r1
.reg t,       r2
.reg low,     r3                ; sum, or the number that flows
.reg high,    r4
.reg least,   r5
.reg value,   r6                ; largest pixel of the NP
.reg most,    r7                ; the largest value of all NPs
.reg index,   r8                ; place in the table
.reg own,     r9                ; number of this NP
.reg ownhigh, r10
.reg top,     r11               ; highest byte of a number of 24 bits
.reg zero,    r12

.include "lib/cds.s"

; Adds the tables of all NPs on a line, towards the end of it, where the totals replace the table.
; Places outside the table hold anything; their sums never meet one of a place inside.
.macro flow number, from, count
        number  index
        SUB     zero, index     ; where the numbers start it is 0, behind it -1, -2 ...
        MOV     index, zero
        MOV     zero, #0
        MOV     low, #0
        MOV     high, #0
        .loop   TABLE + count - 1, TABLE + count - 1
.step:  NBR     low, low, from
        NBR     high, high, from
        LD      own, [index + LOW]
        LD      ownhigh, [index + HIGH]
        ADD     low, own
        ADC     high, ownhigh
        ST      [index + LOW], low
        ST      [index + HIGH], high
        ADD     index, #1
        CMP     index, #TABLE + count - 1
        JNONE   EQ, .step       ; the start is there when the end has seen the whole table
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     zero, #0
        .rept TABLE, k
        ST      [LOW + k], zero
        ST      [HIGH + k], zero
        .endr
        MOV     low, #0
        MOV     high, #0
        MOV     least, #255
        MOV     value, #0
        MOV     pixel, #0
.eight: .rept 8
        cds     f, pixel, t
        ADD     low, f
        ADC     high, #0
        CMP     f, least
        WHERE   LO
          MOV   least, f
        END
        CMP     value, f
        WHERE   LO
          MOV   value, f
        END
        SHR     f, #4           ; every NP counts in a bin of its own
        LD      t, [f + LOW]
        ADD     t, #1
        ST      [f + LOW], t
        ADD     pixel, #1
        .endr
        CMP     pixel, #64
        JANY    LO, .eight
        ST      [LOW + SUM + 2], high
        MOV     t, low
        SHR     t, #4
        ST      [LOW + SUM + 1], t
        AND     low, #15
        ST      [LOW + SUM], low

        CALL    maximum
        OUT     1, most
        MOV     value, #255     ; the least of all is 255 - the largest of 255 - least
        SUB     value, least
        CALL    maximum
        MOV     value, #255
        SUB     value, most
        OUT     0, value

        flow    COL, west, NP_COLS
        flow    ROW, north, NP_ROWS

        ; Now the corner has the totals. All NPs divide, but only the corner is heard.
        LD      low, [LOW + SUM + 1]
        LD      high, [HIGH + SUM + 1]
        MOV     top, high       ; top:high:low := 16 * high:low
        SHR     top, #4
        MOV     t, low
        SHR     t, #4
        SHL     high, #4
        OR      high, t
        SHL     low, #4
        LD      t, [LOW + SUM]
        ADD     low, t
        LD      t, [HIGH + SUM]
        ADC     high, t
        ADC     top, #0
        LD      t, [LOW + SUM + 2]
        ADD     high, t
        LD      t, [HIGH + SUM + 2]
        ADC     top, t
        ADD     low, #(PIXELS / 2) & 0xFF
        ADC     high, #(PIXELS / 2) >> 8
        ADC     top, #0
        MOV     value, #0
        .rept 8, bit            ; a quotient of 8 bits
        SUB     low, #(PIXELS << (7 - bit)) & 0xFF
        SBC     high, #((PIXELS << (7 - bit)) >> 8) & 0xFF
        SBC     top, #(PIXELS << (7 - bit)) >> 16
        WHERE   LO              ; too much: back again
          ADD   low, #(PIXELS << (7 - bit)) & 0xFF
          ADC   high, #((PIXELS << (7 - bit)) >> 8) & 0xFF
          ADC   top, #(PIXELS << (7 - bit)) >> 16
        ELSE
          OR    value, #0x80 >> bit
        END
        .endr

        ROW     t
        CMP     t, #NP_ROWS - 1
        WHERE   EQ
          COL   t
          CMP   t, #NP_COLS - 1
          WHERE EQ
            OUT 2, value
            .rept BINS, k
            LD  t, [LOW + k]
            OUT 3, t
            LD  t, [HIGH + k]
            OUT 3, t
            .endr
          END
        END
        JMP     frame

.include "lib/maximum.s"
