; lib/object_registers.s - memory and registers of programs that include object_box.s

.include "box_registers.s"

.reg u,   r5                    ; (capture) a carry
.reg row, r10                   ; twice the centre of the box
.reg col, r11
