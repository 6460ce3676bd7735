"""Code that is repeated for each vector of 16 NPs.

What NPs compute without each other is written once, as a loop: all of it for one vector, then all
of it for the next. So intermediate values live only while one vector is at work and stay in machine
registers. What a loop has computed, the next may read at neighbours.
"""

from __future__ import annotations

from npchip.engines.wasm.emit.encode import MEMORY, OPS, Function, unsigned
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.engines.wasm.emit.vector_loop import Body, LoopWriter, Piece


class LoopRecorder:
    """Collects the strips of a block.

    What a loop computes for each vector is a *value*. Later strips of the block may ask for it.

    Args:
        out: the function that they go to.
        layout: geometry and addresses.
        many: whether the program has many blocks.
    """

    def __init__(self, out: Function, layout: Layout, *, many: bool) -> None:
        self._out = out
        self._writer = LoopWriter(out, layout, many=many)
        self._pieces: list[Piece] = []
        self._before = Function()
        self._bodies: list[Body] = []
        self._values = 0
        self._here: set[int] = set()  # values of the present loop
        self._shared: dict[int, int] = {}  # those that later strips ask for, numbered
        self._in_planes = False  # whether one asks for other lanes

    @property
    def planes(self) -> int:
        """Planes that are needed to keep values."""
        return self._writer.planes

    def flush(self) -> None:
        """End the loop: its code belongs here."""
        if self._pieces:
            before, self._before.code = self._before.code, bytearray()
            self._bodies.append(Body(len(self._out.code), before, self._pieces))
            self._pieces = []
            self._here.clear()

    def write(self) -> None:
        """Write the strips of a block; its values are gone."""
        if self._bodies:
            self._writer.write(self._bodies, self._shared, in_planes=self._in_planes)
            self._bodies.clear()
            self._in_planes = False
        self._values = 0
        self._shared.clear()

    # ---- the same for every vector

    def op(self, name: str) -> None:
        """An instruction without operands."""
        self._pieces.append(OPS[name])

    def i32(self, value: int) -> None:
        """``i32.const`` of a number from 0 to 63."""
        self._pieces.append(b"\x41" + unsigned(value))

    def v128(self, lanes: bytes) -> None:
        """``v128.const`` of 16 bytes."""
        self._pieces.append(b"\xfd\x0c" + lanes)

    def get_local(self, local: int) -> None:
        """``local.get`` of the same local."""
        self._pieces.append(b"\x20" + unsigned(local))

    def set_local(self, local: int) -> None:
        """``local.set`` of the same local."""
        self._pieces.append(b"\x21" + unsigned(local))

    def tee_local(self, local: int) -> None:
        """``local.tee`` of the same local."""
        self._pieces.append(b"\x22" + unsigned(local))

    def load_same(self, name: str, offset: int) -> None:
        """A load of the same 16 bytes, `offset` bytes from the address on the stack."""
        code, align = MEMORY[name]
        self._pieces.append(code + unsigned(align) + unsigned(offset))

    def zero_before(self, local: int) -> None:
        """Let a local for a vector be 0 before the loop."""
        self._before.v128(bytes(VECTOR))
        self._before.set(local)

    # ---- for each vector its own

    def base(self, local: int = -1) -> None:
        """Push the address that `memory` counts from: what a local holds, or 0."""
        self._pieces.append(("base", local))

    def memory(self, name: str, offset: int) -> None:
        """A load or store of a plane `offset` bytes from the base on the stack."""
        self._pieces.append((name, offset))

    def new_value(self) -> int:
        """A new value."""
        self._values += 1
        return self._values

    def get(self, value: int) -> None:
        """Push a value."""
        if value in self._here:
            self._pieces.append(("get", value))
        else:
            self._shared.setdefault(value, len(self._shared))
            self._pieces.append(("shared", value))

    def set(self, value: int) -> None:
        """Let a value be what is on the stack."""
        self._here.add(value)
        self._pieces.append(("set", value))

    def tee(self, value: int) -> None:
        """The same, and leave it on the stack."""
        self._here.add(value)
        self._pieces.append(("tee", value))

    def computes(self, value: int) -> bool:
        """Whether it is this loop that a value belongs to."""
        return value in self._here

    def get_shifted(self, value: int, distance: int) -> None:
        """Push a value of an earlier loop as it is in other lanes, a distance away."""
        self._pieces.append(("shifted", (value, distance)))
        self._shared.setdefault(value, len(self._shared))
        self._in_planes = True

    def set_padding(self, *, ones: bool) -> None:
        """Let the bits on the stack be `ones` in all lanes that are no NPs."""
        self._pieces.append(("padding", ones))

    def reduce(self, local: int, *, ones: bool) -> None:
        """Join what the vectors leave on the stack in a local: by "and" where `ones`, else "or"."""
        self._before.v128((b"\xff" if ones else b"\x00") * VECTOR)
        self._before.set(local)
        self._pieces.append(("reduce", (local, ones)))
