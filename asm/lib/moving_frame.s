; lib/moving_frame.s - takes a frame and asks whether pixels move
;
; The first code of a trajectory program. It goes on behind the file where pixels move, with rows
; and cols; where none moves, and in the first frame, it goes to the label `still`. From either
; place the program goes back to `frame`. The program includes trajectory.s before this file and
; moving_box.s behind its own code.

        CALL    capture         ; the first frame has no predecessor
        JMP     still
frame:  CALL    capture
        CMP     rows, #0
        JNONE   NE, still
