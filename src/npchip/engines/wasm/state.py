"""The GCU's state: words in the module's memory, of which some are locals while it runs."""

from __future__ import annotations

from npchip.engines.wasm import layout as at
from npchip.engines.wasm.encode import I32, I64, Function


class Words:
    """Writes what reads and changes the GCU's state.

    Args:
        out: the function ``run``.

    Attributes:
        cycles, instructions: locals: of this frame.
        check: local: cycles of a frame at which the host is asked.
        log, data: locals: where the sends of a block go; see `Effects.make_room`.
    """

    def __init__(self, out: Function) -> None:
        self._out = out
        self.cycles = out.local(I64)
        self.instructions = out.local(I64)
        self.check = out.local(I64)
        self.log = out.local(I32)
        self.data = out.local(I32)
        told = Function()
        for local, word in ((self.cycles, at.CYCLES), (self.instructions, at.INSTRUCTIONS)):
            told.i32(0)
            told.get(local)
            told.memory("i64.store", word)
        self._told = bytes(told.code)

    def take(self) -> None:
        """Take over from the host what is in locals."""
        words = (
            (self.cycles, at.CYCLES),
            (self.instructions, at.INSTRUCTIONS),
            (self.check, at.CHECK),
        )
        for local, word in words:
            self._out.i32(0)
            self._out.memory("i64.load", word)
            self._out.set(local)

    def tell(self) -> None:
        """Hand over to the host what is in locals."""
        self._out.code += self._told

    def begin_frame(self) -> None:
        """A frame begins: nothing has been done in it."""
        out = self._out
        out.i32(0)
        out.i32(0)
        out.memory("i32.store", at.CONVERSIONS)
        for local in (self.cycles, self.instructions):
            out.i64(0)
            out.set(local)
        out.i32(0)
        out.memory("i64.load", at.FIRST_CHECK)
        out.set(self.check)

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
