"""Code that reads and writes the control words, which hold the GCU's state (see `layout`)."""

from __future__ import annotations

from collections.abc import Callable

from npchip.engines.wasm.emit.encode import Function


class ControlWords:
    """Writes code that reads and changes control words.

    Args:
        out: the function to write to.
    """

    def __init__(self, out: Function) -> None:
        self._out = out

    def push(self, word: int) -> None:
        """Push a 32-bit word."""
        self._out.i32(0)
        self._out.memory("i32.load", word)

    def increase(self, word: int, count: int) -> None:
        """Add `count` to a 32-bit word."""
        self._out.i32(0)
        self.push(word)
        self._out.i32(count)
        self._out.op("i32.add")
        self._out.memory("i32.store", word)

    def push_long(self, word: int) -> None:
        """Push a 64-bit word."""
        self._out.i32(0)
        self._out.memory("i64.load", word)

    def increase_long(self, word: int, push: Callable[[], None]) -> None:
        """Add to a 64-bit word the number that `push` leaves on the stack."""
        self._out.i32(0)
        self.push_long(word)
        push()
        self._out.op("i64.add")
        self._out.memory("i64.store", word)
