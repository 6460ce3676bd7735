.include "lib/ping.s"
        HALT
