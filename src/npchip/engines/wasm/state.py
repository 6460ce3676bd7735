"""The GCU's state: locals of the module, and words where they cross to the host."""

from __future__ import annotations

from npchip.engines.wasm import layout as at
from npchip.engines.wasm.encode import I32, I64, Function


class Words:
    """The locals of the GCU's state.

    Args:
        out: the function that they belong to.

    Attributes:
        position: frames taken from the ring.
        log: end of the log of sends.
        data: end of the planes sent.
        conversions: of this frame.
        frame: address of the exposed frame.
        cycles, instructions: of this frame.
        check: cycles of a frame at which the host is asked.
    """

    def __init__(self, out: Function) -> None:
        self._out = out
        self.position = out.local(I32)
        self.log = out.local(I32)
        self.data = out.local(I32)
        self.conversions = out.local(I32)
        self.frame = out.local(I32)
        self.cycles = out.local(I64)
        self.instructions = out.local(I64)
        self.check = out.local(I64)
        self._all = (
            (self.position, at.POSITION, "i32"),
            (self.log, at.LOG_END, "i32"),
            (self.data, at.DATA_END, "i32"),
            (self.conversions, at.CONVERSIONS, "i32"),
            (self.frame, at.FRAME, "i32"),
            (self.cycles, at.CYCLES, "i64"),
            (self.instructions, at.INSTRUCTIONS, "i64"),
            (self.check, at.CHECK, "i64"),
        )

    def take(self) -> None:
        """Take all over from the host."""
        self._take(self._all)

    def take_batch(self) -> None:
        """Take over what the host changes when it refills the ring."""
        self._take(self._all[:3])

    def begin_frame(self) -> None:
        """A frame begins: nothing has been done in it."""
        out = self._out
        out.i32(0)
        out.set(self.conversions)
        for local in (self.cycles, self.instructions):
            out.i64(0)
            out.set(local)
        out.i32(0)
        out.memory("i64.load", at.FIRST_CHECK)
        out.set(self.check)

    def _take(self, words: tuple[tuple[int, int, str], ...]) -> None:
        for local, word, kind in words:
            self._out.i32(0)
            self._out.memory(f"{kind}.load", word)
            self._out.set(local)

    def tell(self) -> None:
        """Hand all over to the host."""
        for local, word, kind in self._all:
            self._out.i32(0)
            self._out.get(local)
            self._out.memory(f"{kind}.store", word)
