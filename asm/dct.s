; dct.s - 8 x 8 discrete cosine transform of every NP's pixels, by shifts and adds
;
; With correlated double sampling. The orthonormal DCT-II of F - 128, divided by 8 and rounded:
; 8-bit two's complement, 128 to 255 stand for -128 to -1. Halves are rounded down, because the
; largest quotient is 127.5. Coefficient (v, u), v along the columns and u along the rows, is sent
; as pixel (v, u) of the NP.
;
; One routine transforms eight numbers of 16 bits and is called for the columns, then the rows.
; Mirrored numbers are added and subtracted first. The sums give the even coefficients, the
; differences the odd ones. In units of 1/64 the constants sqrt(2) * cos(k * pi / 16) are
;
;       k            1    2    3    5    6    7
;       exact      88.8 83.6 75.3 50.3 34.6 17.7
;       here       89   84   75   50   35   18
;
; A sum of such products is made from the lowest bit of the constants up: add every number whose
; constant has the bit, halve, go on with the next bit. All four products are halved at once.
;
; Output    dct       picture   coefficient / 8, two's complement, F - 128 = -128 to 127
; Accuracy  at most 2.1 from the exact quotient (constants 1.38, halving 0.14, rounding 0.5); on
;           the bundled clips at most 0.94, where rounding alone makes 0.5. After the inverse
;           40.7 dB PSNR or more, with exact coefficients 0.2 dB more at most in a clip
; Words     489
; Cycles    8,015 per frame (default), 10,320 (conservative)
; Thesis    1.3: 2-D DCT

; Tests     npchip test asm/dct.s
;
; run: drawn  frames=../examples/clips/shapes_drawn.npy machine=default,conservative
; expect: golden
; run: coin   frames=../examples/clips/coin_slide.npy machine=default,conservative
; expect: golden cycles
; run: ball   frames=../examples/clips/ball_fall_30000fps.npy machine=default,conservative
; expect: golden cycles

.output dct, 0, picture
.budget words  489
.budget cycles 8015

.equ SIGNAL, 0
.equ RESET,  64
.equ LOW,    0                  ; the numbers take the place of the samples: low bytes
.equ HIGH,   64                 ; and high bytes
.equ DIFFERENCES, 128           ; 4 x 2 bytes

.reg base,   r15                ; place of the first of eight numbers
.reg stride, r14                ; from there to the next
.reg up,     r13                ; place of a number, going up from the first ...
.reg down,   r12                ; ... and down from the last
.reg two,    r12                ; (later) two strides
.reg x,      r8                 ; a number of 16 bits, and where sums are made
.reg xh,     r9
.reg y,      r10
.reg yh,     r11
.reg a,      r0                 ; four sums or differences
.reg ah,     r1
.reg b,      r2
.reg bh,     r3
.reg c,      r4
.reg ch,     r5
.reg d,      r6
.reg dh,     r7

.include "lib/cds.s"

; n := n + m, and m := n - m in y, where m is not changed
.macro butterfly n, nh, m, mh
        MOV     y, n
        MOV     yh, nh
        SUB     y, m
        SBC     yh, mh
        ADD     n, m
        ADC     nh, mh
.endm

; Loads a number and its mirror image; n := their sum, difference to memory.
.macro mirror n, nh, place
        LD      n, [up + LOW]
        LD      nh, [up + HIGH]
        LD      x, [down + LOW]
        LD      xh, [down + HIGH]
        butterfly n, nh, x, xh
        ST      [DIFFERENCES + place], y
        ST      [DIFFERENCES + place + 1], yh
        ADD     up, stride
        SUB     down, stride
.endm

; Sums of products are made in x, with 2^15 added, so that none is negative and halving is a plain
; shift. They are stored like that: where two of them are added or subtracted it becomes 2^16 or
; 0, and in the end the shift by two pushes it out.
.macro start n, nh
        MOV     x, n
        MOV     xh, nh
        ADD     xh, #0x80
.endm

.macro plus n, nh
        ADD     x, n
        ADC     xh, nh
.endm

.macro minus n, nh
        SUB     x, n
        SBC     xh, nh
.endm

.macro halve
        SHR     xh, #1
        RCR     x
        ADD     xh, #0x40       ; 2^15 again
.endm

; x := (35 * n + or - 84 * m) / 64
.macro even n, nh, sign, m, mh
        start   n, nh           ; 1
        halve
        plus    n, nh           ; 2
        halve
        sign    m, mh           ; 4
        halve
        halve
        sign    m, mh           ; 16
        halve
        plus    n, nh           ; 32
        halve
        sign    m, mh           ; 64
.endm

; x := (75 * n + or - 89 * m + or - 50 * k + or - 18 * l) / 64
.macro odd n, nh, msign, m, mh, ksign, k, kh, lsign, l, lh
        MOV     x, n            ; 1
        MOV     xh, nh
        msign   m, mh
        MOV     y, x            ; wanted twice more
        MOV     yh, xh
        ADD     xh, #0x80
        halve
        plus    n, nh           ; 2
        ksign   k, kh
        lsign   l, lh
        halve
        halve
        plus    y, yh           ; 8
        halve
        msign   m, mh           ; 16
        ksign   k, kh
        lsign   l, lh
        halve
        ksign   k, kh           ; 32
        halve
        plus    y, yh           ; 64
.endm

; Stores a coefficient and goes on to the one after the next.
.macro store n, nh
        ST      [up + LOW], n
        ST      [up + HIGH], nh
        ADD     up, two
.endm

frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     up, #0
.four:  .rept 4
        cds     x, up, y
        SUB     x, #128
        SBC     xh, xh          ; the borrow is the sign
        ST      [up + LOW], x
        ST      [up + HIGH], xh
        ADD     up, #1
        .endr
        CMP     up, #64
        JANY    LO, .four

        MOV     base, #0
        MOV     stride, #8
.column:
        CALL    transform
        ADD     base, #1
        CMP     base, #8
        JANY    LO, .column

        MOV     base, #0
        MOV     stride, #1
.row:   CALL    transform
        .rept 8                 ; both passes are 8 times orthonormal ones: 8 / 64 is left
        LD      x, [base + LOW]
        LD      xh, [base + HIGH]
        ADD     x, #31          ; rounded, halves down
        ADC     xh, #0
        SHL     xh, #2
        SHR     x, #6
        OR      x, xh
        OUT     0, x
        ADD     base, #1
        .endr
        CMP     base, #64
        JANY    LO, .row
        JMP     frame

; Transforms eight numbers in place. The result is sqrt(8) times that of the orthonormal DCT.
transform:
        MOV     up, base
        MOV     down, stride
        SHL     down, #3
        SUB     down, stride
        ADD     down, base
        mirror  a, ah, 0
        mirror  b, bh, 2
        mirror  c, ch, 4
        mirror  d, dh, 6

        MOV     two, stride
        ADD     two, two
        MOV     up, base        ; the even ones
        butterfly b, bh, c, ch
        MOV     c, y            ; (1) - (2)
        MOV     ch, yh
        butterfly a, ah, d, dh
        MOV     d, y            ; (0) - (3)
        MOV     dh, yh
        butterfly a, ah, b, bh
        store   a, ah           ; 0
        even    c, ch, plus, d, dh
        store   x, xh           ; 2
        store   y, yh           ; 4
        even    d, dh, minus, c, ch
        store   x, xh           ; 6

        LD      a, [DIFFERENCES]
        LD      ah, [DIFFERENCES + 1]
        LD      b, [DIFFERENCES + 2]
        LD      bh, [DIFFERENCES + 3]
        LD      c, [DIFFERENCES + 4]
        LD      ch, [DIFFERENCES + 5]
        LD      d, [DIFFERENCES + 6]
        LD      dh, [DIFFERENCES + 7]
        MOV     up, base        ; the odd ones
        ADD     up, stride
        odd     b, bh, plus, a, ah, plus, c, ch, plus, d, dh
        store   x, xh           ; 1
        odd     a, ah, minus, c, ch, minus, d, dh, minus, b, bh
        store   x, xh           ; 3
        odd     d, dh, minus, b, bh, plus, a, ah, plus, c, ch
        store   x, xh           ; 5
        odd     c, ch, minus, d, dh, minus, b, bh, plus, a, ah
        store   x, xh           ; 7
        RET
