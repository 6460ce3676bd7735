; lib/follow_registers.s - memory, registers and constants of the programs that follow objects
;
; Included before what is a program's own. Three sets of names share the registers: pixels, rows of
; bits, numbers. SOLID and WITHIN, banks, are the program's own.

.include "cds.s"

.equ THRESHOLD, 24
.equ AHEAD,     1
.ifndef WIDE
.equ WIDE,      0               ; 1: places of pixels have 16 bits
.endif
.ifndef SMOOTH
.equ SMOOTH,    1               ; 0: no means of 2 x 2
.endif
.ifndef GHOSTS
.equ GHOSTS,    1               ; 0: what is likely a ghost does not depend on its surroundings
.endif
.if (AHEAD != 1) & (AHEAD != 2) & (AHEAD != 4) & (AHEAD != 8)
.error "AHEAD must be 1, 2, 4 or 8"
.endif

.equ SMALLEST, 6                ; pixels of an object
.equ COAST,    9                ; frames that a track lasts

.equ SIGNAL,     0              ; banks of the NP's memory
.equ RESET,      64
.equ CODE,       64             ; (later) of each pixel:
.equ GHOST,      192            ;   in the mask, likely a ghost; 191 or 193: no ghost
.equ BACK,       2              ;   not in the mask
.equ SOLID,      64             ; (later) rows 1 to 8 of the mask, a byte each
.equ BACKGROUND, 128
.equ VARS,       192            ; rows 1 to 8 of bits, the neighbours' next to them, and others

.if NP_ROWS * NP_COLS < 1_024
.equ CELL,     64               ; as much for each NP: 16 bits hold the sum over all of them
.elif NP_ROWS * NP_COLS < 4_096
.equ CELL,     16
.elif NP_ROWS * NP_COLS < 16_384
.equ CELL,     4
.else
.equ CELL,     1
.endif
.equ HALF,     CELL * NP_ROWS * NP_COLS / 512   ; of the NPs

.reg p,       r0                ; 8*y + x
.reg f,       r1
.reg t,       r2                ; short-lived
.reg b,       r3
.reg step,    r4
.reg k,       r5
.reg d,       r6
.reg pf,      r7                ; the pixel before: picture,
.reg pb,      r6                ; background
.reg pn,      r9                ; and code
.reg n,       r10
.reg a,       r11
.reg far,     r12

.reg slow,    r13               ; 255 in every second frame
.reg u,       r4                ; step of the background
.reg level,   r7                ; half the mean of the surroundings; 0 in the first frame
.reg sum,     r8                ; of the background
.reg SUM,     r9

.reg y,       r0                ; (rows of bits)
.reg m,       r1
.reg h,       r3
.reg v,       r4
.reg at,      r5
.reg bits,    r6
.reg any,     r6
.reg c,       r7
.reg w,       r8
.reg dst,     r9
.reg rows,    r10

.reg x,       r5                ; (numbers) the fraction of s
.reg s,       r6                ; 16 bits, s and S
.reg S,       r7
.reg value,   r3
.reg most,    r4
.reg area,    r10
.reg AREA,    r11
.reg down,    r8                ; sum of the rows,
.reg DOWN,    r9
.reg right,   r12               ; of the columns
.reg RIGHT,   r13
.reg yoff,    r5
.reg xoff,    r4
.reg rl,      r1                ; remainder
.reg RH,      r3
.reg axis,    r9
.reg last,    r8
.reg e,       r1
.reg E,       r0
.reg vl,      r3
.reg vh,      r4
.reg there,   r0

.if WIDE
.reg pixel,   r13               ; of the expected place
.reg C,       r11
.reg T,       r12
.reg THERE,   r13
.reg LAST,    r12
.else
.reg pixel,   r7
.endif

.include "threshold.s"
