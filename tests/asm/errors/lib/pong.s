        ADD     r0, #1
.include "ping.s"
