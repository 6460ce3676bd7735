; fusion_lut.s - where an object is in space, seen by this camera and by another at right angles
;
; Camera 1 of a rig runs this program, camera 2 runs sighting.s and is its partner. Each finds the
; middle of the object by a threshold, in half pixels. The pair of NPs, or rather of NP columns, in
; which it lies picks an entry of the lookup table: a rough x and y. The entries are spread over
; the NPs: column i of camera 1 and column j of camera 2 meet in NP (j mod NP_ROWS, i), and only
; that NP goes on. It corrects the entry along both rays; ratios are 2^SHIFT, so that shifts take
; the place of divisions, and products are added up bit by bit.
;
; Outputs   valid       scalar    1 where there is a position; else x, y and z are 0
;           seen        scalar    1 this camera sees an object, 2 the other one, 3 both, 0 none
;           twice_row   scalar    of this camera, top + bottom of the box; 0 where it sees nothing
;           twice_col   scalar    the same for left + right
;           x           scalar16  position in Q12, that is in 1/4096 m, signed (two's complement)
;           y           scalar16  the same for y
;           z           scalar16  the same for z
; Inputs    0, 2      seen and twice_col of camera 2
; Memory    192 on    6 bytes for each entry, that of the smaller j first: x and y in Q12 + 32768,
;                     each low byte, high byte, and a byte that is not 0 where there is none
; Constants THRESHOLD   1 to 255, 128 if not defined
;           DARK        0 or 1, 0 if not defined; see tracking.s
;           SHIFT       1 to 14: both ratios are 2^SHIFT pixels; 6 if not defined
;           X1, Y2      9421 if not defined: x of camera 1 and y of camera 2 in Q12, here 2.3 m
;           Y1, Z1, X2  0 if not defined: their other coordinates
;           UP          1 where camera 1 looks along +y, -1 along -y; 1 if not defined
;           ROUNDS      0, 1 or 2, 0 if not defined. 0: keep x or y of the entry, whichever lies
;                       nearer to the middle of its NP; 1: always keep y; 2: and correct it once
;                       more
; Geometry  up to 10 x 10 NPs: products then fit in 24 bits
; Words     417
; Cycles    1,723 per frame (default), 2,718 (conservative) on coin_slide;
;           1,669 to 1,798 and 2,665 to 2,793 with a position, up to 1,988 and 3,038 with ROUNDS=2
; Thesis    2.2.4 (equations 2.6 and 2.7, corrected), 4.1.1

; Tests     npchip test asm/fusion_lut.s, with the table of examples/rigs/chip.yaml; npchip fuse runs
;           the program for any rig
;
; run: space  frames=../examples/rigs/ball.1.gif partner=sighting.s partner-frames=../examples/rigs/ball.2.gif memory=192=../examples/templates/fusion_chip.npy machine=default,conservative
; expect: golden cycles
; expect: seen[0] == 2
; expect: valid[0] == 0
; expect: x[0] == 0
; expect: valid[1..39] == 1
; run: rounds frames=../examples/rigs/ball.1.gif partner=sighting.s partner-frames=../examples/rigs/ball.2.gif memory=192=../examples/templates/fusion_chip.npy define=ROUNDS=2
; expect: valid[0] == 0
; expect: valid[1..39] == 1
; run: blind  levels=0 partner=sighting.s partner-frames=../examples/rigs/ball.2.gif memory=192=../examples/templates/fusion_chip.npy
; expect: seen == 2
; expect: valid == 0
; run: coin   frames=../examples/clips/coin_slide.npy partner=sighting.s partner-frames=../examples/clips/coin_slide.npy memory=192=../examples/templates/fusion_chip.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy partner=sighting.s partner-frames=../examples/clips/ball_fall_30000fps.npy memory=192=../examples/templates/fusion_chip.npy machine=default,conservative
; expect: golden cycles

.equ THRESHOLD, 128
.equ DARK,      0
.equ SHIFT,     6
.equ X1,        9421            ; 2.3 m
.equ Y1,        0
.equ Z1,        0
.equ X2,        0
.equ Y2,        9421
.equ UP,        1
.equ ROUNDS,    0

.equ DROP,   SHIFT + 1          ; bits of a product that are dropped: offsets are in half pixels
.equ NARROW, (8 - DROP) * (DROP < 8) + (DROP - 8) * (DROP > 8)  ; shifts beside that by a byte
.equ MORE,   (NP_COLS - 1) / NP_ROWS    ; entries of an NP beside the first

.require NP_ROWS <= 10, "an offset from the middle of the frame has 7 bits, a product 24"
.require NP_COLS <= 10, "an offset from the middle of the frame has 7 bits, a product 24"

.output valid,     0, scalar
.output seen,      1, scalar
.output twice_row, 2, scalar
.output twice_col, 3, scalar
.output x,         4, scalar16
.output y,         5, scalar16
.output z,         6, scalar16
.budget words  408 + 5 * MORE + 4 * NARROW + 3 * DARK
.if ROUNDS == 2
.budget cycles 1988 + 24 * DARK
.else
.budget cycles 1798 + 24 * DARK ; boxes from 32 to 62 and from 1 to 15: most bits in all products
.endif

.equ ENTRY,  192
.equ H1,     128                ; variables: offsets from the middle of the frame in half pixels,
.equ V1,     129                ; 8 bits, signed as the equations need it
.equ H2,     130

.equ SIZE,   6                  ; bytes of an entry
.equ BIAS,   0x8000             ; positions carry it, so that a word that fits has no third byte

.include "lib/object_registers.s"
.reg seen,   r12
.reg other,  r13                ; twice the centre's column in camera 2

.reg near1,  r3                 ; (choice) from the middle of its NP, in half pixels
.reg near2,  r4
.reg entry,  r15

.reg d0,     r0                 ; (position) distance from a camera along its axis, 24 bits
.reg d1,     r1
.reg d2,     r3
.reg p0,     r4                 ; product
.reg p1,     r5
.reg p2,     r6
.reg h,      r7                 ; one of H1, V1, H2
.reg x0,     r8                 ; x + BIAS, 24 bits
.reg x1,     r9
.reg x2,     r10
.reg y0,     r11
.reg y1,     r12
.reg y2,     r13
.reg over,   r14                ; not 0: something did not fit

; near := distance of an object from the middle of its NP; s is its place + 1, from the edge
.macro nearness near, s
        MOV     near, s
        AND     near, #2 * 8 - 1
        SUB     near, #8
        WHERE   LO
          MOV   t, #0
          SUB   t, near
          MOV   near, t
        END
.endm

; A coordinate of the entry; where there is none, over is set.
.macro fetch low, high, none
        LD      low, [entry + ENTRY]
        ADD     entry, #1
        LD      high, [entry + ENTRY]
        ADD     entry, #1
        LD      over, [entry + ENTRY]
        MOV     none, #0
.endm

; d := a position - where a camera is
.macro distance p, q, r, camera
        MOV     d0, p
        MOV     d1, q
        MOV     d2, r
        SUB     d0, #(camera + BIAS) & 0xFF
        SBC     d1, #(camera + BIAS) >> 8
        SBC     d2, #0
.endm

; A position of an offset from a camera, which carries BIAS already
.macro place p, q, r, camera
        ADD     p, #camera & 0xFF
        ADC     q, #camera >> 8 & 0xFF
        ADC     r, #camera >> 16 & 0xFF
.endm

.macro send port, p, q
        SUB     q, #BIAS >> 8
        OUT     port, p
        OUT     port, q
.endm

frame:  CALL    capture
        MOV     seen, #0
        MOV     row, #0
        MOV     col, #0
        CMP     rows, #0
        JNONE   NE, ask
        CALL    centre
        MOV     seen, #1
ask:    OUT     2, row
        OUT     3, col
        IN      t, 0
        IN      other, 2
        ADD     t, t
        OR      seen, t
        OUT     1, seen
        CMP     seen, #3
        JANY    EQ, both

        MOV     t, #0
        OUT     0, t
        .rept 3, port
        OUT     port + 4, t
        OUT     port + 4, t
        .endr
        JMP     frame

both:
.if UP > 0
        MOV     h, #ROWS - 1
        SUB     h, row
.else
        MOV     h, row
        SUB     h, #ROWS - 1
.endif
        ST      [V1], h
        MOV     h, col
        SUB     h, #COLS - 1
        ST      [H1], h
        MOV     h, #COLS - 1    ; camera 2 sees y grow to the left
        SUB     h, other
        ST      [H2], h

        ADD     col, #1         ; from the frame's edge, in half pixels
        ADD     other, #1
.if ROUNDS == 0
        nearness near1, col
        nearness near2, other
.endif
        SHR     col, #4         ; columns of NPs
        SHR     other, #4
        MOV     entry, #0
        .rept MORE
        CMP     other, #NP_ROWS
        WHERE   HS
          SUB   other, #NP_ROWS
          ADD   entry, #SIZE
        END
        .endr
        ROW     t
        CMP     t, other
        WHERE   EQ              ; from here on only the NP that has the entry
          COL   t
          CMP   t, col
          WHERE EQ

.if ROUNDS == 0
        CMP     near1, near2
        JNONE   LO, keep_y
        fetch   x0, x1, x2
        CALL    along2
        CALL    along1
        JMP     height
keep_y: ADD     entry, #3
        fetch   y0, y1, y2
        CALL    along1
        CALL    along2
.else
        ADD     entry, #3
        fetch   y0, y1, y2
        .rept ROUNDS
        CALL    along1
        CALL    along2
        .endr
.endif
height: distance y0, y1, y2, Y1
        LD      h, [V1]
        CALL    product
        place   p0, p1, p2, Z1

        MOV     t, #1
        OR      over, p2
        OR      over, x2
        OR      over, y2
        CMP     over, #0
            WHERE NE
        MOV     t, #0
        MOV     x0, t
        MOV     y0, t
        MOV     p0, t
        MOV     x1, #BIAS >> 8
        MOV     y1, x1
        MOV     p1, x1
            END
        OUT     0, t
        send    4, x0, x1
        send    5, y0, y1
        send    6, p0, p1
          END
        END
        JMP     frame

; To x on the ray of camera 1, from y.
along1: distance y0, y1, y2, Y1
        LD      h, [H1]
        CALL    product
        place   p0, p1, p2, X1
        MOV     x0, p0
        MOV     x1, p1
        MOV     x2, p2
        RET

; To y on the ray of camera 2, from x.
along2: distance x0, x1, x2, X2
        LD      h, [H2]
        CALL    product
        place   p0, p1, p2, Y2
        MOV     y0, p0
        MOV     y1, p1
        MOV     y2, p2
        RET

; p := d * h / 2^DROP, rounded, halves up, + BIAS. Changes d and h.
product:
        CMP     h, #0x80
        JANY    LO, .sum
        MOV     t, #0           ; both change their signs
        SUB     t, h
        MOV     h, t
        MOV     t, #0
        SUB     t, d0
        MOV     d0, t
        MOV     t, #0
        SBC     t, d1
        MOV     d1, t
        MOV     t, #0
        SBC     t, d2
        MOV     d2, t
.sum:   MOV     p0, #0
        MOV     p1, #0
        MOV     p2, #0
        SHL     h, #1           ; it has seven bits
        .rept 7
        ADD     p0, p0
        ADC     p1, p1
        ADC     p2, p2
        SHL     h, #1
        JNONE   CS, .clear
        ADD     p0, d0
        ADC     p1, d1
        ADC     p2, d2
.clear:
        .endr
        ADD     p0, #(1 << DROP - 1) & 0xFF
        ADC     p1, #1 << DROP - 1 >> 8
        ADC     p2, #0
        MOV     t, p2           ; the sign
        ADD     t, t
        SBC     t, t
.if DROP < 8
        .rept NARROW
        ADD     p0, p0
        ADC     p1, p1
        ADC     p2, p2
        ADC     t, t
        .endr
.else
        .rept NARROW
        MOV     h, t
        ADD     h, h
        RCR     p2
        RCR     p1
        .endr
.endif
        MOV     p0, p1          ; without the low byte
        MOV     p1, p2
        MOV     p2, t
        ADD     p1, #BIAS >> 8
        ADC     p2, #0
        OR      over, p2
        RET

.include "lib/object_box.s"
