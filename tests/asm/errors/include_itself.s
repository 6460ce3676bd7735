        ADD     r0, #1
.include "include_itself.s"
