; lib/trajectory_large.s - trajectory_common.s for places of 16 bits
;
; Included before a program's own outputs, which go on at port 5, and registers, from r12. The
; routines of these programs are in moving_box.s, bounds_large.s and inside_large.s.
;
; Thesis    2.1

.include "box_registers.s"

.equ PREVIOUS, 128              ; the frame before

.output valid,         0, scalar
.output center_row,    1, scalar16
.output center_col,    2, scalar16
.output predicted_row, 3, scalar16
.output predicted_col, 4, scalar16
.position center_row, center_col
.position predicted_row, predicted_col, 1

.reg LOW,      r10              ; high bytes
.reg high,     r9               ; the last row of the box
.reg HIGH,     r11
.reg CENTER,   r11

; CENTER:center := the centre of the box in one axis, which base numbers
.macro middle_large bits
        MOV     value, bits
        CALL    bounds
        ADD     center, low     ; (first + last) >> 1
        ADC     CENTER, LOW
        SHR     CENTER, #1
        RCR     center
.endm

; LOW:low := the last of so many pixels
.macro limit pixels
        MOV     low, #(pixels - 1) & 0xFF
        MOV     LOW, #(pixels - 1) >> 8
.endm

; Sends a number of 16 bits.
.macro send port, x, X
        OUT     port, x
        OUT     port, X
.endm

; Sends a frame in which nothing moves.
.macro send_still
        MOV     t, #0
        OUT     0, t
        .rept   4, port
        send    port + 1, t, t
        .endr
.endm
