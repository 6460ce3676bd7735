.include "pong.s"
