; lib/box_registers.s - memory and registers of programs that find a bounding box
;
; Included by these programs, or for them by trajectory_common.s and object_registers.s. bounds.s,
; and all files that lead to it, need these registers; r10 to r15 are the program's.

.equ SIGNAL, 0                  ; banks of the NP's memory
.equ RESET,  64

.reg pixel,  r0                 ; 8*y + x, the same in every NP
.reg f,      r1
.reg t,      r2                 ; short-lived
.reg rows,   r3                 ; rows of the NP in the box: a bit for each, y = 0 leftmost
.reg cols,   r4                 ; columns in it, x = 0 leftmost
.reg value,  r5
.reg bits,   r6                 ; pixels of a row that are not in the box, x = 0 leftmost
.reg most,   r6                 ; (later) the largest value of all NPs
.reg base,   r7
.reg low,    r8
.reg center, r9
