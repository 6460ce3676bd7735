"""Records the bodies of a block's vector loops, which compute 16 NPs in each iteration.

A body does all that NPs compute independently of each other, so that intermediate values live for
one iteration only and stay in registers. A later loop may read the results at neighbours.
"""

from __future__ import annotations

from npchip.engines.wasm.emit.encode import OPS, Function, local_code, memory_code, unsigned
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.engines.wasm.emit.vector_loop import Body, LoopWriter, Piece


class LoopRecorder:
    """Records the vector loops of a block.

    A *slot* holds what a body computes for each vector. Later loops of the block may read it.

    Args:
        out: the function to write to.
        layout: addresses in the module's memory.
        many: whether the program has many blocks.
    """

    def __init__(self, out: Function, layout: Layout, *, many: bool) -> None:
        self._out = out
        self._writer = LoopWriter(out, layout, many=many)
        self._pieces: list[Piece] = []
        self._before = Function()
        self._bodies: list[Body] = []
        self._slots = 0
        self._here: set[int] = set()  # slots of the current body
        self._shared: dict[int, int] = {}  # slots that later loops read, numbered
        self._in_planes = False  # whether one is used shifted

    def flush(self) -> None:
        """End the current loop. Its code goes to the present end of the function."""
        if self._pieces:
            before, self._before.code = self._before.code, bytearray()
            self._bodies.append(Body(len(self._out.code), before, self._pieces))
            self._pieces = []
            self._here.clear()

    def write(self) -> None:
        """Write the loops of a block and forget its slots."""
        if self._bodies:
            self._writer.write(self._bodies, self._shared, in_planes=self._in_planes)
            self._bodies.clear()
            self._in_planes = False
        self._slots = 0
        self._shared.clear()

    # ---- the same code in each iteration

    def op(self, name: str) -> None:
        """Record an instruction without immediates."""
        self._pieces.append(OPS[name])

    def i32(self, value: int) -> None:
        """Record ``i32.const`` of a number from 0 to 63."""
        self._pieces.append(b"\x41" + unsigned(value))

    def v128(self, lanes: bytes) -> None:
        """Record ``v128.const`` of 16 bytes."""
        self._pieces.append(b"\xfd\x0c" + lanes)

    def use_local(self, kind: str, local: int) -> None:
        """Record ``local.get``, ``local.set`` or ``local.tee``."""
        self._pieces.append(local_code(kind, local))

    def load_same(self, name: str, offset: int) -> None:
        """Record a load of the same 16 bytes in each iteration."""
        self._pieces.append(memory_code(name, offset))

    def zero_before(self, local: int) -> None:
        """Set the local of a vector to 0 before the loop."""
        self._before.v128(bytes(VECTOR))
        self._before.set(local)

    # ---- code that depends on the iteration

    def base(self, local: int = -1) -> None:
        """Push the address that `memory` is relative to: 0, or the number in a local."""
        self._pieces.append(("base", local))

    def memory(self, name: str, offset: int) -> None:
        """Record a load or store of a vector of a plane: base on the stack + `offset`."""
        self._pieces.append((name, offset))

    def new_slot(self) -> int:
        """Return the number of a new slot."""
        self._slots += 1
        return self._slots

    def get(self, slot: int) -> None:
        """Push the vector in a slot."""
        if slot in self._here:
            self._pieces.append(("get", slot))
        else:
            self._shared.setdefault(slot, len(self._shared))
            self._pieces.append(("shared", slot))

    def set(self, slot: int) -> None:
        """Pop a vector into a slot."""
        self._here.add(slot)
        self._pieces.append(("set", slot))

    def tee(self, slot: int) -> None:
        """Copy the vector on the stack to a slot."""
        self._here.add(slot)
        self._pieces.append(("tee", slot))

    def computes(self, slot: int) -> bool:
        """Return whether the current body computes a slot."""
        return slot in self._here

    def get_shifted(self, slot: int, distance: int) -> None:
        """Push the lanes of a slot of an earlier loop that are `distance` lanes further on."""
        self._pieces.append(("shifted", (slot, distance)))
        self._shared.setdefault(slot, len(self._shared))
        self._in_planes = True

    def set_padding(self, *, ones: bool) -> None:
        """Set the padding lanes of the bits on the stack to 1 (`ones`) or 0."""
        self._pieces.append(("padding", ones))

    def reduce(self, local: int, *, ones: bool) -> None:
        """Reduce the vectors that the iterations leave on the stack into a local.

        Args:
            local: the local.
            ones: whether to start with ones and use "and", rather than "or".
        """
        self._before.v128((b"\xff" if ones else b"\x00") * VECTOR)
        self._before.set(local)
        self._pieces.append(("reduce", (local, ones)))
