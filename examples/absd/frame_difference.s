; frame_difference.s - asm/frame_difference.s with an instruction of our own, ABSD (absd.yaml)
;
; Output    difference   picture   |f(t) - f(t-1)| of every pixel; 0 in the first frame

.equ SIGNAL,   0                ; banks of the NP's memory
.equ RESET,    64
.equ PREVIOUS, 128

.output difference, 0, picture

.reg pixel,  r0                 ; 8*y + x, the same in every NP
.reg f,      r1                 ; this frame
.reg change, r2                 ; the frame before, then the difference
.reg first,  r3                 ; 1 in the first frame

        MOV     first, #1
frame:  EXPOSE
        SAMPLE  reset, RESET
        SAMPLE  signal, SIGNAL
        MOV     pixel, #0

.pixel: LD      f, [pixel + SIGNAL]
        LD      change, [pixel + RESET]
        SUB     f, change       ; correlated double sampling
        WHERE   LO
          MOV   f, #0
        END
        LD      change, [pixel + PREVIOUS]
        CMP     first, #1
        WHERE   EQ
          MOV   change, f
        END
        ST      [pixel + PREVIOUS], f
        ABSD    change, f
        OUT     0, change
        ADD     pixel, #1
        CMP     pixel, #64
        JANY    LO, .pixel

        MOV     first, #0
        JMP     frame
