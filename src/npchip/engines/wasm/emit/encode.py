"""The binary format of WebAssembly: opcodes, numbers, sections.

It holds only what the translator needs (https://webassembly.github.io/spec/core/binary).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache, partial
from itertools import groupby
from typing import Final, Literal

I32: Final = 0x7F
I64: Final = 0x7E
V128: Final = 0x7B


def unsigned(value: int) -> bytes:
    """Encode a number that is not negative as LEB128."""
    if value < 0x80:
        return _BYTES[value]
    parts = bytearray()
    while value >= 0x80:
        parts.append(value & 0x7F | 0x80)
        value >>= 7
    parts.append(value)
    return bytes(parts)


@cache
def signed(value: int) -> bytes:
    """Encode a signed number as LEB128."""
    parts = bytearray()
    while not -0x40 <= value < 0x40:
        parts.append(value & 0x7F | 0x80)
        value >>= 7
    parts.append(value & 0x7F)
    return bytes(parts)


_BYTES: Final = [bytes([value]) for value in range(0x80)]

_SIMPLE: Final = """
    unreachable 00  else 05  end 0b  return 0f  drop 1a  select 1b  i32.eqz 45  i32.eq 46
    i32.ne 47  i32.lt_u 49  i32.gt_u 4b  i32.ge_u 4f  i64.lt_s 53  i64.ge_s 59  i32.ctz 68
    i32.popcnt 69  i32.add 6a  i32.sub 6b  i32.mul 6c  i32.div_u 6e  i32.and 71  i32.or 72
    i32.xor 73  i32.shl 74  i32.shr_u 76  i64.add 7c  i64.mul 7e  i64.xor 85  i64.shr_u 88
    i32.wrap_i64 a7  i64.extend_i32_u ad
"""
"""Instructions of one byte."""
_VECTOR: Final = """
    i8x16.splat 0f  i32x4.splat 11  i8x16.eq 23  i8x16.lt_s 25  i8x16.ge_u 2c  v128.not 4d
    v128.and 4e  v128.or 50  v128.xor 51  v128.bitselect 52  v128.any_true 53  i8x16.bitmask 64
    i8x16.narrow_i16x8_u 66  i8x16.shl 6b  i8x16.shr_u 6d  i8x16.add 6e  i8x16.add_sat_u 70
    i8x16.sub 71  i8x16.sub_sat_u 73  i16x8.extadd_pairwise_i8x16_u 7d
    i32x4.extadd_pairwise_i16x8_s 7e  i16x8.q15mulr_sat_s 82  i16x8.narrow_i32x4_s 85
    i16x8.extend_low_i8x16_u 89  i16x8.extend_high_i8x16_u 8a  i16x8.shl 8b  i16x8.add 8e
    i16x8.sub 91  i32x4.shr_u ad  i32x4.add ae  i32x4.mul b5
"""
"""Instructions of SIMD, which begin with 0xFD."""
_MEMORY: Final = """
    i32.load 28  i64.load 29  i32.load8_u 2d  i32.load16_u 2f  i32.store 36  i64.store 37
    i32.store8 3a
"""
"""Loads and stores of one byte."""
_VECTOR_MEMORY: Final = "v128.load 00  v128.store 0b  v128.load64_zero 5d"


def _codes(table: str, encode: Callable[[int], bytes]) -> dict[str, bytes]:
    """Return the codes of a table of names and hexadecimal numbers."""
    words = table.split()
    return {name: encode(int(code, 16)) for name, code in zip(words[::2], words[1::2], strict=True)}


def _simd(code: int) -> bytes:
    return b"\xfd" + unsigned(code)


OPS: Final = {
    **_codes(_SIMPLE, lambda code: bytes([code])),
    **_codes(_VECTOR, _simd),
    "block": b"\x02\x40",  # this and the next two are without a result
    "loop": b"\x03\x40",
    "if": b"\x04\x40",
    "memory.copy": b"\xfc\x0a\x00\x00",  # target, source, length
    "memory.fill": b"\xfc\x0b\x00",  # address, byte, length
}
"""Instructions without operands in the code."""


_ACCESSES: Final = {  # any alignment
    name: code + b"\x00"
    for name, code in {**_codes(_MEMORY, unsigned), **_codes(_VECTOR_MEMORY, _simd)}.items()
}
_HALF: Final = 1 << 63
_LOCAL: Final = {"get": b"\x20", "set": b"\x21", "tee": b"\x22"}


def local_code(kind: str, local: int) -> bytes:
    """Encode ``local.get``, ``local.set`` or ``local.tee``."""
    return _LOCAL[kind] + unsigned(local)


def memory_code(name: str, offset: int) -> bytes:
    """Encode a load or store at the address on the stack plus `offset`."""
    return _ACCESSES[name] + unsigned(offset)


_NUMBERED: Final[Mapping[str, Callable[[int], bytes]]] = {
    "local.get": partial(local_code, "get"),
    "local.set": partial(local_code, "set"),
    "local.tee": partial(local_code, "tee"),
    "i32.const": lambda number: b"\x41" + signed(number),
    "i64.const": lambda number: b"\x42" + signed((number + _HALF) % (2 * _HALF) - _HALF),
    "br": lambda depth: b"\x0c" + unsigned(depth),
    "br_if": lambda depth: b"\x0d" + unsigned(depth),
    **{name: partial(memory_code, name) for name in _ACCESSES},
}
"""Instructions with a number: a local, a constant, a label, or the offset of an address."""


@lru_cache(1 << 14)  # most texts come again, in another block or after the next edit
def _encoded(text: str) -> bytes:
    words = iter(text.split())
    return b"".join(OPS[w] if w in OPS else _NUMBERED[w](int(next(words))) for w in words)


@dataclass(eq=False)
class Function:
    """A function that is being written.

    Attributes:
        parameters: types of the parameters.
        results: types of the results.
        code: instructions so far.
        locals: types of the locals that are not parameters.
    """

    parameters: Sequence[int] = ()
    results: Sequence[int] = ()
    code: bytearray = field(default_factory=bytearray)
    locals: list[int] = field(default_factory=list)

    def local(self, kind: int, count: int = 1) -> int:
        """Add `count` locals and return the number of the first."""
        first = len(self.parameters) + len(self.locals)
        self.locals += [kind] * count
        return first

    def write(self, text: str) -> None:
        """Write instructions as in WebAssembly's text format, without names of locals."""
        self.code += _encoded(text)

    def op(self, *names: str) -> None:
        """Write instructions without immediates."""
        for name in names:
            self.code += OPS[name]

    def get(self, local: int) -> None:
        """Write ``local.get``."""
        self.code += b"\x20" + unsigned(local)

    def set(self, local: int) -> None:
        """Write ``local.set``."""
        self.code += b"\x21" + unsigned(local)

    def tee(self, local: int) -> None:
        """Write ``local.tee``."""
        self.code += b"\x22" + unsigned(local)

    def i32(self, value: int) -> None:
        """Write ``i32.const``."""
        self.code += b"\x41" + signed(value)

    def i64(self, value: int) -> None:
        """Write ``i64.const``."""
        self.code += b"\x42" + signed(value)

    def v128(self, lanes: bytes) -> None:
        """Write ``v128.const`` of 16 bytes."""
        self.code += b"\xfd\x0c" + lanes

    def shuffle(self, lanes: Sequence[int]) -> None:
        """Write ``i8x16.shuffle``: lanes 0-15 are the first operand's, 16-31 the second's."""
        self.code += b"\xfd\x0d" + bytes(lanes)

    def memory(self, name: str, offset: int) -> None:
        """Write a load or store at the address on the stack plus `offset`."""
        self.code += memory_code(name, offset)

    def lane64(self, access: Literal["load", "store"], offset: int, lane: int) -> None:
        """Write ``v128.load64_lane`` or ``v128.store64_lane``."""
        code = b"\x57" if access == "load" else b"\x5b"
        self.code += b"\xfd" + code + b"\x00" + unsigned(offset) + bytes([lane])

    def call(self, function: int) -> None:
        """Write ``call``."""
        self.code += b"\x10" + unsigned(function)

    def advance(self, steps: Mapping[int, int]) -> None:
        """Add a number to each of some locals."""
        for local, step in steps.items():
            self.write(f"local.get {local} i32.const {step} i32.add local.set {local}")

    def increase(self, address: int, count: int) -> None:
        """Add `count` to the 32-bit number at a fixed address."""
        self.write(f"""
            i32.const 0 i32.const 0 i32.load {address} i32.const {count} i32.add i32.store {address}
        """)

    def increase_long(self, address: int, push: Callable[[], None]) -> None:
        """Add to the 64-bit number at a fixed address the one that `push` leaves on the stack."""
        self.write(f"i32.const 0 i32.const 0 i64.load {address}")
        push()
        self.write(f"i64.add i64.store {address}")

    def end_counting_loop(self, local: int, step: int, end: int) -> None:
        """End a ``loop``: add `step` to a local, and repeat while it is less than `end`."""
        self.write(f"""
            local.get {local} i32.const {step} i32.add local.tee {local}
            i32.const {end} i32.lt_u br_if 0 end
        """)

    def br(self, depth: int) -> None:
        """Write ``br``."""
        self.code += b"\x0c" + unsigned(depth)

    def br_table(self, depths: Sequence[int], otherwise: int) -> None:
        """Write ``br_table``."""
        self.code += b"\x0e" + _vector([unsigned(item) for item in depths]) + unsigned(otherwise)

    def encoded(self) -> bytes:
        """Return the function's entry in the code section."""
        groups = [(len(list(same)), kind) for kind, same in groupby(self.locals)]
        declared = _vector([unsigned(count) + bytes([kind]) for count, kind in groups])
        return _sized(declared + bytes(self.code) + b"\x0b")


Signature = tuple[tuple[int, ...], tuple[int, ...]]


def module(
    imports: Sequence[tuple[str, Signature]],
    functions: Sequence[Function],
    exported: Mapping[str, int],
    pages: int,
    data: Sequence[tuple[int, bytes]],
) -> bytes:
    """Encode a module that exports its memory as ``memory`` and some functions.

    Args:
        imports: names and signatures of host functions; they are numbered first.
        functions: the module's functions.
        exported: numbers of the functions that it exports, by name.
        pages: size of the memory in pages of 64 KiB; it does not grow.
        data: initial content of the memory, with addresses; the rest is 0.
    """
    signatures = [signature for _, signature in imports]
    signatures += [(tuple(item.parameters), tuple(item.results)) for item in functions]
    types = list(dict.fromkeys(signatures))
    number = {signature: index for index, signature in enumerate(types)}
    imported = [
        _sized(b"host") + _sized(name.encode()) + b"\x00" + unsigned(number[signature])
        for name, signature in imports
    ]
    own = [unsigned(number[signature]) for signature in signatures[len(imports) :]]
    exports = [_sized(b"memory") + b"\x02\x00"]
    exports += [_sized(name.encode()) + b"\x00" + unsigned(at) for name, at in exported.items()]
    sections = {
        1: [b"\x60" + _sized(parameters) + _sized(results) for parameters, results in types],
        2: imported,
        3: own,
        5: [b"\x01" + unsigned(pages) + unsigned(pages)],
        7: exports,
        10: [item.encoded() for item in functions],
        11: [b"\x00\x41" + signed(at) + b"\x0b" + _sized(content) for at, content in data],
    }
    content = [bytes([key]) + _sized(_vector(items)) for key, items in sections.items() if items]
    return b"\x00asm\x01\x00\x00\x00" + b"".join(content)


def custom_section(name: str, content: bytes) -> bytes:
    """Encode a custom section, which may follow a module."""
    return b"\x00" + _sized(_sized(name.encode()) + content)


def _vector(items: Sequence[bytes]) -> bytes:
    return unsigned(len(items)) + b"".join(items)


def _sized(data: Sequence[int]) -> bytes:
    """Encode bytes, preceded by their number."""
    return unsigned(len(data)) + bytes(data)
