"""How the code of bodies is repeated: once for each vector, or in a loop over the vectors.

Code takes the longer to compile the more there is of it, and a loop needs no more registers than
one vector. It has a price where bodies are short, and where values go on to other bodies.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from npchip.engines.wasm.emit.encode import I32, MEMORY, OPS, V128, Function, unsigned
from npchip.engines.wasm.emit.layout import VECTOR, Layout

Piece = bytes | tuple[str, Any]
"""Code that is the same for every vector; or the kind of a piece, and what it is about."""

LOOPED: Final = 200
"""Pieces, of all vectors, from which on a body becomes a loop: shorter ones would be slower."""
LOOPED_OF_MANY: Final = 25
"""The same in a program of many blocks, which would take long to compile otherwise."""


class Body(NamedTuple):
    """A body.

    Attributes:
        place: in the code of the function.
        before: code in front of it.
        pieces: its code.
    """

    place: int
    before: bytes | bytearray
    pieces: Sequence[Piece]


class LoopWriter:
    """Writes bodies.

    A value that later bodies ask for is kept in a local for each vector. Where one of a block's
    bodies is a loop, or asks for it in other lanes, it is kept in a plane.

    Args:
        out: the function that they go to.
        layout: geometry and addresses.
        many: whether the program has many blocks.

    Attributes:
        planes: how many are needed to keep values.
    """

    def __init__(self, out: Function, layout: Layout, *, many: bool) -> None:
        self._out = out
        self._layout = layout
        self._count = layout.vectors
        self._looped = LOOPED_OF_MANY if many else LOOPED
        self.planes = 0
        self._position = out.local(I32)  # first byte of the vector that a loop is at
        self._at = _local("get", self._position)
        self._begin, self._end = self._control()
        self._vector_locals: list[int] = []  # see `_vector_local`
        self._plane_locals: list[int] = []  # see `_locals_of`
        self._cached: dict[
            Piece, bytes | Sequence[bytes]
        ] = {}  # code of pieces, whatever the block
        self._cached_rolled: dict[Piece, bytes] = {}

    def write(self, bodies: Sequence[Body], shared: Mapping[int, int], *, in_planes: bool) -> None:
        """Write the bodies of a block.

        Args:
            bodies: in their order.
            shared: values that bodies ask for which have not computed them, numbered.
            in_planes: whether they must be in planes.
        """
        rolled = [self._is_rolled(body) for body in bodies]
        self._shared = shared
        self._in_planes = in_planes or any(rolled)
        if self._in_planes:
            self.planes = max(self.planes, len(shared))
        self._kept = {
            (kind, value): self._stored(kind, value)
            for value in (shared if any(rolled) else ())
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
        long = len(body.pieces) * self._count >= self._looped
        return long and self._count > 1

    # ---- once for each vector

    def _unrolled(self, pieces: Sequence[Piece]) -> list[bytes]:
        codes: list[bytes | Sequence[bytes]] = []
        for piece in pieces:
            if isinstance(piece, bytes):
                codes.append(piece)
            else:
                known = self._cached.get(piece)
                codes.append(self._unrolled_code(*piece) if known is None else known)
        return [
            code if isinstance(code, bytes) else code[index]
            for index in range(self._count)
            for code in codes
        ]

    def _unrolled_code(self, kind: str, about: Any) -> bytes | Sequence[bytes]:
        """The code of a piece, for each vector where it differs."""
        code: bytes | list[bytes]
        match kind:
            case "get" | "set" | "tee":
                return self._own(kind, about)
            case "shared":
                return [self._vector(about, index) for index in range(self._count)]
            case "shifted":
                start = self._plane(about[0]) + about[1]
                return [_ORIGIN + _access("v128.load", start + at) for at in self._layout.starts]
            case "base":
                code = _ORIGIN if about < 0 else _local("get", about)
            case "padding":
                code = [b""] * self._count
                code[-1] = self._padding(ones=about)
            case "reduce":
                code = [_reduce(*about)] * self._count
                code[0] = _local("set", about[0])
            case _:
                code = [_access(kind, about + start) for start in self._layout.starts]
        self._cached[kind, about] = code  # it is the same in every block
        return code

    def _own(self, kind: str, value: int) -> bytes | Sequence[bytes]:
        """Take a value of this body, or push it."""
        if value not in self._shared or (self._in_planes and kind == "get"):
            return _local(kind, self._vector_local(value))
        if not self._in_planes:
            return [_local(kind, self._locals_of(value) + index) for index in range(self._count)]
        keep = (
            _local(kind, self._vector_local(value))
            + _ORIGIN
            + _local("get", self._vector_local(value))
        )
        plane = self._plane(value)
        return [keep + _access("v128.store", plane + start) for start in self._layout.starts]

    def _vector(self, value: int, index: int) -> bytes:
        """Push a vector of a value of an earlier body."""
        if self._in_planes:
            return _ORIGIN + _access("v128.load", self._plane(value) + VECTOR * index)
        return _local("get", self._locals_of(value) + index)

    def _padding(self, *, ones: bool) -> bytes:
        """Let the bits of the last vector be `ones` in lanes that are no NPs."""
        inside = self._layout.lanes - self._layout.starts[-1]
        if inside == VECTOR:
            return b""
        code = Function()
        here, outside = (b"\x00", b"\xff") if ones else (b"\xff", b"\x00")
        code.v128(here * inside + outside * (VECTOR - inside))
        code.op("v128.or" if ones else "v128.and")
        return bytes(code.code)

    # ---- in a loop

    def _control(self) -> tuple[bytes, bytes]:
        """What is in front of the code of a loop, and behind it."""
        begin, end = Function(), Function()
        begin.i32(0)
        begin.set(self._position)
        begin.loop()
        end.get(self._position)
        end.i32(VECTOR)
        end.op("i32.add")
        end.tee(self._position)
        end.i32(self._layout.stride)
        end.op("i32.lt_u")
        end.br_if(0)
        end.op("end")
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

    def _stored(self, kind: str, value: int) -> bytes:
        """Take a value that later bodies ask for."""
        local = self._vector_local(value)
        store = self._at + _local("get", local) + _access("v128.store", self._plane(value))
        return _local(kind, local) + store

    def _rolled_code(self, kind: str, about: Any) -> bytes:
        """The code of a piece, but of one that takes a value which later bodies ask for."""
        match kind:
            case "get" | "set" | "tee":
                code = _local(kind, self._vector_local(about))
            case "shared":
                return self._at + _access("v128.load", self._plane(about))
            case "shifted":
                return self._at + _access("v128.load", self._plane(about[0]) + about[1])
            case "base":
                code = self._at
                if about >= 0:
                    code += _local("get", about) + OPS["i32.add"]
            case "padding":
                code = b""
                if self._layout.lanes < self._layout.stride:
                    code = self._at + _access("v128.load", self._layout.inside)
                    code += OPS["v128.not"] + OPS["v128.or"] if about else OPS["v128.and"]
            case "reduce":
                code = _reduce(*about)
            case _:
                code = _access(kind, about)
        self._cached_rolled[kind, about] = code  # it is the same in every block
        return code

    # ---- where values are

    def _vector_local(self, value: int) -> int:
        """The local of a value, whatever the block: it holds one vector at a time."""
        while value >= len(self._vector_locals):
            self._vector_locals.append(self._out.local(V128))
        return self._vector_locals[value]

    def _locals_of(self, value: int) -> int:
        """The first local of a value that later bodies ask for: one for each vector."""
        number = self._shared[value]
        while number >= len(self._plane_locals):
            self._plane_locals.append(self._out.local(V128, self._count))
        return self._plane_locals[number]

    def _plane(self, value: int) -> int:
        return self._layout.kept + self._shared[value] * self._layout.stride


_ORIGIN: Final = b"\x41\x00"
_LOCAL: Final = {"get": b"\x20", "set": b"\x21", "tee": b"\x22"}


def _local(kind: str, local: int) -> bytes:
    return _LOCAL[kind] + unsigned(local)


def _access(name: str, offset: int) -> bytes:
    code, align = MEMORY[name]
    return code + unsigned(align) + unsigned(offset)


def _reduce(local: int, ones: bool) -> bytes:
    return _local("get", local) + OPS["v128.and" if ones else "v128.or"] + _local("set", local)
