"""Records and writes the vector loops of a block, which compute 16 NPs in each iteration.

The body of a loop does all that NPs compute independently of each other, so that intermediate
results stay in registers. What later loops read is kept in planes. Loops are rolled, or unrolled if
their body is short, which is faster.
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
    signed,
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

    Args:
        out: the function to write to.
        layout: addresses in the module's memory.
    """

    def __init__(self, out: Function, layout: Layout) -> None:
        self._out = out
        self._layout = layout
        self._position = out.local(I32)  # offset of the current vector in its plane
        self._locals: list[int] = []  # see `_local`
        self._cached: dict[tuple[Piece, int], bytes] = {}

    def write(self, bodies: Sequence[Body], shared: Mapping[int, int]) -> None:
        """Write the vector loops of a block.

        Args:
            bodies: their bodies in program order.
            shared: slots that later loops read, numbered; they are kept in planes.
        """
        where = self._layout
        where.planes = max(where.planes, len(shared))
        code = self._out.code
        parts: list[bytes | bytearray] = []
        ends = [*[body.place for body in bodies[1:]], len(code)]
        for body, end in zip(bodies, ends, strict=True):
            parts.append(body.before)
            if len(body.pieces) * where.vectors < LOOPED:
                for start in where.starts:
                    parts += self._codes(body.pieces, shared, start)
            else:
                begin, repeat = self._control()
                parts += [begin, *self._codes(body.pieces, shared, -1), repeat]
            parts.append(code[body.place : end])
        code[bodies[0].place :] = b"".join(parts)

    def _control(self) -> tuple[bytes, bytes]:
        """Return the code before and after the body of a rolled loop."""
        begin, end = Function(), Function()
        begin.write(f"i32.const 0 local.set {self._position} loop")
        end.end_counting_loop(self._position, VECTOR, self._layout.stride)
        return bytes(begin.code), bytes(end.code)

    def _codes(self, pieces: Sequence[Piece], shared: Mapping[int, int], start: int) -> list[bytes]:
        """Return the code of a body for the vector at `start` in its plane; -1 in a rolled loop."""
        codes: list[bytes] = []
        for piece in pieces:
            if isinstance(piece, bytes):
                codes.append(piece)
                continue
            kind, about = piece
            if kind in _SLOTS and (about[0] if kind == "shifted" else about) in shared:
                codes.append(self._shared(kind, about, shared, start))
                continue
            code = self._cached.get((piece, start))
            if code is None:
                code = self._cached[piece, start] = self._code(kind, about, start)
            codes.append(code)
        return codes

    def _at(self, start: int) -> bytes:
        return local_code("get", self._position) if start < 0 else b"\x41" + signed(start)

    def _shared(self, kind: str, about: Any, shared: Mapping[int, int], start: int) -> bytes:
        """Return the code of a piece about a slot that later loops read."""
        slot, distance = about if kind == "shifted" else (about, 0)
        plane = self._layout.kept + shared[slot] * self._layout.stride + distance
        if kind in {"shared", "shifted"}:
            return self._at(start) + memory_code("v128.load", plane)
        local = self._local(slot)
        if kind == "get":
            return local_code("get", local)
        store = self._at(start) + local_code("get", local) + memory_code("v128.store", plane)
        return local_code(kind, local) + store

    def _code(self, kind: str, about: Any, start: int) -> bytes:
        """Return the code of any other piece."""
        where = self._layout
        match kind:
            case "get" | "set" | "tee":
                return local_code(kind, self._local(about))
            case "base" if about < 0:
                return self._at(start)
            case "base":
                return self._at(start) + local_code("get", about) + OPS["i32.add"]
            case "padding":
                if where.lanes == where.stride or 0 <= start <= where.lanes - VECTOR:
                    return b""
                inside = memory_code("v128.load", where.inside)
                return self._at(start) + inside + OPS["v128.and"]
            case "reduce":
                return local_code("get", about) + OPS["v128.or"] + local_code("set", about)
        return memory_code(kind, about)

    def _local(self, slot: int) -> int:
        """Return the local of a slot within an iteration. All blocks share it."""
        while slot >= len(self._locals):
            self._locals.append(self._out.local(V128))
        return self._locals[slot]


_SLOTS: Final = frozenset({"get", "set", "tee", "shared", "shifted"})


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
            self._writer.write(self._bodies, self._shared)
            self._bodies.clear()
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

    def clear_padding(self) -> None:
        """Clear the padding lanes of the vector on the stack."""
        self._pieces.append(("padding", 0))

    def reduce(self, local: int) -> None:
        """Reduce the vectors that the iterations leave on the stack into a local, by "or"."""
        self._before.v128(bytes(VECTOR))
        self._before.set(local)
        self._pieces.append(("reduce", local))
