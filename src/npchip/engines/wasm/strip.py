"""Code that is repeated for each vector of 16 NPs.

What NPs compute without their neighbours is written once, as a strip: all of it for the first
vector, then all of it for the second, with locals and addresses that go on. So intermediate
values live only while one vector is at work and stay in machine registers.
"""

from __future__ import annotations

from collections.abc import Sequence

from npchip.engines.wasm.encode import MEMORY, OPS, Function, unsigned
from npchip.engines.wasm.layout import VECTOR

_GET, _SET, _TEE = b"\x20", b"\x21", b"\x22"


class Strip:
    """Collects the code of a strip.

    Args:
        out: the function that it goes to.
        count: number of vectors.
    """

    def __init__(self, out: Function, count: int) -> None:
        self._out = out
        self._count = count
        self._pieces: list[bytes | tuple[bytes, ...]] = []  # for all vectors, or one for each
        self._locals: dict[tuple[bytes, int], tuple[bytes, ...]] = {}
        self._offsets: dict[int, tuple[bytes, ...]] = {}

    def flush(self) -> None:
        """Write the strip for each vector and begin a new one."""
        pieces = self._pieces
        if not pieces:
            return
        for index in range(self._count):
            self._out.code += b"".join(
                [piece if piece.__class__ is bytes else piece[index] for piece in pieces]  # type: ignore[misc]
            )
        pieces.clear()

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

    def get_one(self, local: int) -> None:
        """``local.get`` of the same local."""
        self._pieces.append(_GET + unsigned(local))

    def set_one(self, local: int) -> None:
        """``local.set`` of the same local."""
        self._pieces.append(_SET + unsigned(local))

    def tee_one(self, local: int) -> None:
        """``local.tee`` of the same local."""
        self._pieces.append(_TEE + unsigned(local))

    def one(self, name: str, offset: int) -> None:
        """A load of the same 16 bytes, `offset` bytes from the address on the stack."""
        code, align = MEMORY[name]
        self._pieces.append(code + unsigned(align) + unsigned(offset))

    # ---- for each vector its own

    def get(self, first: int) -> None:
        """``local.get`` from `first` on."""
        self._local(_GET, first)

    def set(self, first: int) -> None:
        """``local.set`` from `first` on."""
        self._local(_SET, first)

    def tee(self, first: int) -> None:
        """``local.tee`` from `first` on."""
        self._local(_TEE, first)

    def memory(self, name: str, offset: int) -> None:
        """A load or store of a plane `offset` bytes from the address on the stack."""
        code, align = MEMORY[name]
        self._pieces.append(code + unsigned(align))
        found = self._offsets.get(offset)
        if found is None:
            ends = range(offset, offset + VECTOR * self._count, VECTOR)
            found = self._offsets[offset] = tuple([unsigned(end) for end in ends])
        self._pieces.append(found)

    def each(self, codes: Sequence[bytes]) -> None:
        """Code for each vector."""
        self._pieces.append(tuple(codes))

    def first(self, code: bytes | bytearray) -> None:
        """Code for the first vector alone."""
        self.each([bytes(code), *[b""] * (self._count - 1)])

    def rest(self, code: bytes | bytearray) -> None:
        """Code for all vectors but the first."""
        self.each([b"", *[bytes(code)] * (self._count - 1)])

    def last(self, code: bytes | bytearray) -> None:
        """Code for the last vector alone."""
        self.each([*[b""] * (self._count - 1), bytes(code)])

    def _local(self, code: bytes, first: int) -> None:
        found = self._locals.get((code, first))
        if found is None:
            numbers = range(first, first + self._count)
            found = tuple([code + unsigned(number) for number in numbers])
            self._locals[code, first] = found
        self._pieces.append(found)
