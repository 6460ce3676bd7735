"""Records and writes the vector loops of a block, which compute 16 NPs in each iteration.

The body of a loop does all that NPs compute independently of each other, so that intermediate
results stay in registers. Loops are unrolled or rolled. Rolled code is smaller and compiles faster.
Unrolled code is faster if the body is short, and it can keep the slots that later loops read in
locals.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from npchip.engines.wasm.emit.encode import (
    I32,
    OPS,
    V128,
    Function,
    local_code,
    memory_code,
    unsigned,
)
from npchip.engines.wasm.emit.layout import VECTOR, Layout

Piece = bytes | tuple[str, Any]
"""Code that is the same in each iteration, or (kind, argument) of code that is not."""

LOOPED: Final = 200
"""Pieces in all iterations from which on a loop is rolled."""


class Body(NamedTuple):
    """The body of a vector loop.

    Attributes:
        place: the loop's position in the code of the function.
        before: code that goes before the loop.
        pieces: code of the body.
    """

    place: int
    before: bytes | bytearray
    pieces: Sequence[Piece]


class LoopWriter:
    """Writes vector loops.

    A slot that later loops read is kept in one local for each vector, or in a plane if a loop of
    the block is rolled or reads it shifted.

    Args:
        out: the function to write to.
        layout: addresses in the module's memory.
    """

    def __init__(self, out: Function, layout: Layout) -> None:
        self._out = out
        self._layout = layout
        self._count = layout.vectors
        self._position = out.local(I32)  # offset of the current vector in its plane
        self._at = local_code("get", self._position)
        self._begin, self._end = self._control()
        self._vector_locals: list[int] = []  # see `_vector_local`
        self._plane_locals: list[int] = []  # see `_locals_of`
        # Code of pieces that is the same in every block, unrolled and rolled.
        self._cached: dict[Piece, bytes | Sequence[bytes]] = {}
        self._cached_rolled: dict[Piece, bytes] = {}

    def write(self, bodies: Sequence[Body], shared: Mapping[int, int], *, in_planes: bool) -> None:
        """Write the vector loops of a block.

        Args:
            bodies: their bodies in program order.
            shared: slots that later loops read, numbered.
            in_planes: whether these must be in planes.
        """
        rolled = [self._is_rolled(body) for body in bodies]
        self._shared = shared
        self._in_planes = in_planes or any(rolled)
        if self._in_planes:
            self._layout.planes = max(self._layout.planes, len(shared))
        self._kept = {
            (kind, slot): self._stored(kind, slot)
            for slot in (shared if any(rolled) else ())
            for kind in ("set", "tee")
        }
        code = self._out.code
        parts: list[bytes | bytearray] = []
        ends = [*[body.place for body in bodies[1:]], len(code)]
        for body, is_rolled, end in zip(bodies, rolled, ends, strict=True):
            parts.append(body.before)
            parts += self._rolled(body.pieces) if is_rolled else self._unrolled(body.pieces)
            parts.append(code[body.place : end])
        code[bodies[0].place :] = b"".join(parts)

    def _is_rolled(self, body: Body) -> bool:
        long = len(body.pieces) * self._count >= LOOPED
        return long and self._count > 1

    # ---- unrolled

    def _unrolled(self, pieces: Sequence[Piece]) -> list[bytes]:
        codes = [
            piece
            if isinstance(piece, bytes)
            else self._cached.get(piece) or self._unrolled_code(*piece)
            for piece in pieces
        ]
        return [
            code if isinstance(code, bytes) else code[index]
            for index in range(self._count)
            for code in codes
        ]

    def _unrolled_code(self, kind: str, about: Any) -> bytes | Sequence[bytes]:
        """Return the code of a piece, a list of one for each iteration if they differ."""
        code: bytes | list[bytes]
        match kind:
            case "get" | "set" | "tee":
                return self._own(kind, about)
            case "shared":
                return [self._vector(about, index) for index in range(self._count)]
            case "shifted":
                load, plane = "v128.load", self._plane(about[0]) + about[1]
                return [_ORIGIN + memory_code(load, plane + start) for start in self._layout.starts]
            case "base":
                code = _ORIGIN if about < 0 else local_code("get", about)
            case "padding":
                code = [b""] * self._count
                code[-1] = self._padding()
            case "reduce":
                code = [_reduce(about)] * self._count
                code[0] = local_code("set", about)
            case _:
                code = [memory_code(kind, about + start) for start in self._layout.starts]
        self._cached[kind, about] = code
        return code

    def _own(self, kind: str, slot: int) -> bytes | Sequence[bytes]:
        """Return code that pops or pushes a slot of this loop."""
        if slot not in self._shared or (self._in_planes and kind == "get"):
            return local_code(kind, self._vector_local(slot))
        if not self._in_planes:
            first = self._locals_of(slot)
            return [local_code(kind, first + index) for index in range(self._count)]
        local = self._vector_local(slot)
        keep = local_code(kind, local) + _ORIGIN + local_code("get", local)
        plane = self._plane(slot)
        return [keep + memory_code("v128.store", plane + start) for start in self._layout.starts]

    def _vector(self, slot: int, index: int) -> bytes:
        """Return code that pushes a vector of an earlier loop's slot."""
        if self._in_planes:
            return _ORIGIN + memory_code("v128.load", self._plane(slot) + VECTOR * index)
        return local_code("get", self._locals_of(slot) + index)

    def _padding(self) -> bytes:
        """Return code that clears the padding lanes of the last vector."""
        inside = self._layout.lanes - self._layout.starts[-1]
        if inside == VECTOR:
            return b""
        code = Function()
        code.v128(b"\xff" * inside + bytes(VECTOR - inside))
        code.op("v128.and")
        return bytes(code.code)

    # ---- rolled

    def _control(self) -> tuple[bytes, bytes]:
        """Return the code before and after the body of a rolled loop."""
        begin, end = Function(), Function()
        begin.i32(0)
        begin.set(self._position)
        begin.op("loop")
        end.end_counting_loop(self._position, VECTOR, self._layout.stride)
        return bytes(begin.code), bytes(end.code)

    def _rolled(self, pieces: Sequence[Piece]) -> list[bytes]:
        kept, fixed = self._kept, self._cached_rolled
        codes = [
            piece
            if isinstance(piece, bytes)
            else kept.get(piece) or fixed.get(piece) or self._rolled_code(*piece)
            for piece in pieces
        ]
        return [self._begin, *codes, self._end]

    def _stored(self, kind: str, slot: int) -> bytes:
        """Return code that pops a vector into a slot and its plane."""
        local = self._vector_local(slot)
        store = self._at + local_code("get", local) + memory_code("v128.store", self._plane(slot))
        return local_code(kind, local) + store

    def _rolled_code(self, kind: str, about: Any) -> bytes:
        """Return the code of a piece other than a `_stored` one."""
        match kind:
            case "get" | "set" | "tee":
                code = local_code(kind, self._vector_local(about))
            case "shared":
                return self._at + memory_code("v128.load", self._plane(about))
            case "shifted":
                return self._at + memory_code("v128.load", self._plane(about[0]) + about[1])
            case "base":
                code = self._at
                if about >= 0:
                    code += local_code("get", about) + OPS["i32.add"]
            case "padding":
                code = b""
                if self._layout.lanes < self._layout.stride:
                    code = self._at + memory_code("v128.load", self._layout.inside)
                    code += OPS["v128.and"]
            case "reduce":
                code = _reduce(about)
            case _:
                code = memory_code(kind, about)
        self._cached_rolled[kind, about] = code
        return code

    # ---- where slots are

    def _vector_local(self, slot: int) -> int:
        """Return the local of a slot within an iteration. All blocks share it."""
        while slot >= len(self._vector_locals):
            self._vector_locals.append(self._out.local(V128))
        return self._vector_locals[slot]

    def _locals_of(self, slot: int) -> int:
        """Return the first of the locals, one for each vector, of a slot for later loops."""
        number = self._shared[slot]
        while number >= len(self._plane_locals):
            self._plane_locals.append(self._out.local(V128, self._count))
        return self._plane_locals[number]

    def _plane(self, slot: int) -> int:
        return self._layout.kept + self._shared[slot] * self._layout.stride


_ORIGIN: Final = b"\x41\x00"


def _reduce(local: int) -> bytes:
    return local_code("get", local) + OPS["v128.or"] + local_code("set", local)


class LoopRecorder:
    """Records the vector loops of a block.

    A *slot* holds what a body computes for each vector. Later loops of the block may read it.

    Args:
        out: the function to write to.
        layout: addresses in the module's memory.
    """

    def __init__(self, out: Function, layout: Layout) -> None:
        self._out = out
        self._writer = LoopWriter(out, layout)
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

    def clear_padding(self) -> None:
        """Clear the padding lanes of the vector on the stack."""
        self._pieces.append(("padding", 0))

    def reduce(self, local: int) -> None:
        """Reduce the vectors that the iterations leave on the stack into a local, by "or"."""
        self._before.v128(bytes(VECTOR))
        self._before.set(local)
        self._pieces.append(("reduce", local))
