"""The GCU's state: words in the module's memory."""

from __future__ import annotations

from collections.abc import Callable

from npchip.engines.wasm.emit.encode import Function


class ControlWords:
    """Writes what reads and changes the GCU's state.

    Words stay in memory: a processor adds to them there in one instruction, and a local that
    every block changes takes long to compile.

    Args:
        out: where to.
    """

    def __init__(self, out: Function) -> None:
        self._out = out

    def push(self, word: int) -> None:
        """Push a word of 32 bits."""
        self._out.i32(0)
        self._out.memory("i32.load", word)

    def increase(self, word: int, count: int) -> None:
        """Add to a word of 32 bits."""
        self._out.i32(0)
        self.push(word)
        self._out.i32(count)
        self._out.op("i32.add")
        self._out.memory("i32.store", word)

    def push_long(self, word: int) -> None:
        """Push a word of 64 bits."""
        self._out.i32(0)
        self._out.memory("i64.load", word)

    def increase_long(self, word: int, push: Callable[[], None]) -> None:
        """Add what `push` leaves on the stack, 64 bits, to a word."""
        self._out.i32(0)
        self.push_long(word)
        push()
        self._out.op("i64.add")
        self._out.memory("i64.store", word)
