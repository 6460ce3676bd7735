"""Arithmetic on bytes of which some bits are known.

A byte is a pair: the mask of the known bits, and their values. A bit is a pair of one bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

Bits = tuple[int, int]
UNKNOWN: Final[Bits] = (0, 0)
ZERO_BIT: Final[Bits] = (1, 0)
ONE_BIT: Final[Bits] = (1, 1)


def constant(value: int) -> Bits:
    """Return a byte with all bits known."""
    return 255, value & 255


def bit(value: bool | None) -> Bits:
    """Return a bit; None makes it unknown."""
    return UNKNOWN if value is None else (1, int(value))


def truth(value: Bits) -> bool | None:
    """Return a bit as a Boolean; None if it is unknown."""
    return bool(value[1]) if value[0] & 1 else None


def join(a: Bits, b: Bits) -> Bits:
    """Return the bits that both agree on."""
    known = a[0] & b[0] & ~(a[1] ^ b[1])
    return known, a[1] & known


def least(value: Bits) -> int:
    """Return the smallest possible value."""
    return value[1]


def most(value: Bits) -> int:
    """Return the largest possible value."""
    return value[1] | (~value[0] & 255)


def complement(value: Bits, width: int = 255) -> Bits:
    """Return all known bits inverted."""
    return value[0], ~value[1] & value[0] & width


def both(a: Bits, b: Bits) -> Bits:
    """Return the bitwise AND."""
    zeros = (a[0] & ~a[1]) | (b[0] & ~b[1])
    ones = a[1] & b[1]
    return zeros | ones, ones


def either(a: Bits, b: Bits) -> Bits:
    """Return the bitwise OR."""
    ones = a[1] | b[1]
    zeros = (a[0] & ~a[1]) & (b[0] & ~b[1])
    return zeros | ones, ones


def differ(a: Bits, b: Bits) -> Bits:
    """Return the exclusive OR."""
    known = a[0] & b[0]
    return known, (a[1] ^ b[1]) & known


def add(a: Bits, b: Bits, carry: Bits) -> tuple[Bits, Bits]:
    """Return the sum and its carry.

    A bit of the sum is known if both its bits are known, and the carry into it is the same for
    the smallest and for the largest operands.
    """
    low = least(a) + least(b) + carry[1]
    high = most(a) + most(b) + (carry[1] if carry[0] else 1)
    into_low = low ^ least(a) ^ least(b)  # the carries with all unknown bits clear
    into_high = high ^ most(a) ^ most(b)  # the carries with all unknown bits set
    known = a[0] & b[0] & ~(into_low ^ into_high) & 255
    out = ~(low ^ high) >> 8 & 1
    return (known, low & known), (out, low >> 8 & out)


def subtract(a: Bits, b: Bits, borrow: Bits) -> tuple[Bits, Bits]:
    """Return the difference and its borrow."""
    result, carry = add(a, complement(b), complement(borrow, 1))
    return result, complement(carry, 1)


def shift_left(value: Bits, count: int) -> Bits:
    """Shift by a count modulo 256; zeros come in."""
    count = min(count & 255, 8)
    return (value[0] << count & 255) | ((1 << count) - 1), value[1] << count & 255


def shift_right(value: Bits, count: int) -> Bits:
    """Shift by a count modulo 256; zeros come in."""
    count = min(count & 255, 8)
    return value[0] >> count | (0xFF00 >> count & 255), value[1] >> count


def equal(a: Bits, b: Bits) -> Bits:
    """Return the bit a == b."""
    if (a[1] ^ b[1]) & a[0] & b[0]:
        return ZERO_BIT
    return ONE_BIT if a[0] & b[0] == 255 else UNKNOWN


def lower(a: Bits, b: Bits) -> Bits:
    """Return the bit a < b."""
    if most(a) < least(b):
        return ONE_BIT
    return ZERO_BIT if least(a) >= most(b) else UNKNOWN


def byte(value: Bits) -> Bits:
    """Return a bit as a byte."""
    return 254 | value[0], value[1]


def bit_of(value: Bits, index: int) -> Bits:
    """Return bit number `index` modulo 8 of a byte."""
    return value[0] >> (index & 7) & 1, value[1] >> (index & 7) & 1


def select(condition: Bits, then: Bits, otherwise: Bits) -> Bits:
    """Return `then` if the condition is set, else `otherwise`."""
    chosen = truth(condition)
    return join(then, otherwise) if chosen is None else then if chosen else otherwise


OPERATIONS: Final[Mapping[str, Callable[..., Bits]]] = {
    "+": lambda a, b: add(a, b, ZERO_BIT)[0],
    "-": lambda a, b: subtract(a, b, ZERO_BIT)[0],
    "&": both,
    "|": either,
    "^": differ,
    "<<": shift_left,
    ">>": shift_right,
    "~": complement,
    "==": equal,
    "!=": lambda a, b: complement(equal(a, b), 1),
    "<": lower,
    ">": lambda a, b: lower(b, a),
    ">=": lambda a, b: complement(lower(a, b), 1),
    "<=": lambda a, b: complement(lower(b, a), 1),
    "and": both,
    "or": either,
    "not": lambda a: complement(a, 1),
    "not_wire": lambda a: complement(a, 1),
    "bit": bit_of,
    "byte": byte,
    "select": select,
    "select_bit": select,
    "carry": lambda a, b, c=ZERO_BIT: add(a, b, c)[1],
    "borrow": lambda a, b, c=ZERO_BIT: subtract(a, b, c)[1],
}
_OF_SAME: Final[Mapping[str, Callable[..., Bits]]] = {
    "+": lambda a, _: shift_left(a, 1),
    "-": lambda *_: constant(0),
    "^": lambda *_: constant(0),
    **dict.fromkeys(("==", "<=", ">="), lambda *_: ONE_BIT),
    **dict.fromkeys(("!=", "<", ">"), lambda *_: ZERO_BIT),
    "carry": lambda a, *_: bit_of(a, 7),
    "borrow": lambda _a, _b, c=ZERO_BIT: c,
}
"""Operations on two arguments that are the same."""


def transfer(op: str, *args: Bits | int, same: bool = False) -> Bits:
    """Return the known bits of the result of an operation; none if the operation is unknown.

    Args:
        op: name of the operation in `npchip.isa.ir.OPERATIONS`.
        args: known bits of the arguments; of a constant its value.
        same: whether the first two arguments are certainly equal.
    """
    function = (_OF_SAME.get(op) if same else None) or OPERATIONS.get(op)
    return UNKNOWN if function is None else function(*args)
