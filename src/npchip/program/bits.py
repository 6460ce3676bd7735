"""Bytes of which some bits are known: what can be said of a register without running a program.

A byte is a pair (which bits are known, their values). A bit is the same with one bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

Bits = tuple[int, int]
UNKNOWN: Final[Bits] = (0, 0)
ZERO_BIT: Final[Bits] = (1, 0)
ONE_BIT: Final[Bits] = (1, 1)


def constant(value: int) -> Bits:
    """A byte that is known."""
    return 255, value & 255


def bit(value: bool | None) -> Bits:
    """A bit that may be known."""
    return UNKNOWN if value is None else (1, int(value))


def truth(value: Bits) -> bool | None:
    """A bit as a Boolean; None where it is unknown."""
    return bool(value[1]) if value[0] & 1 else None


def join(a: Bits, b: Bits) -> Bits:
    """What holds of both."""
    known = a[0] & b[0] & ~(a[1] ^ b[1])
    return known, a[1] & known


def least(value: Bits) -> int:
    """The smallest byte that it can be."""
    return value[1]


def most(value: Bits) -> int:
    """The largest byte that it can be."""
    return value[1] | (~value[0] & 255)


def complement(value: Bits, width: int = 255) -> Bits:
    """All known bits turned over."""
    return value[0], ~value[1] & value[0] & width


def both(a: Bits, b: Bits) -> Bits:
    """And."""
    zeros = (a[0] & ~a[1]) | (b[0] & ~b[1])
    ones = a[1] & b[1]
    return zeros | ones, ones


def either(a: Bits, b: Bits) -> Bits:
    """Or."""
    ones = a[1] | b[1]
    zeros = (a[0] & ~a[1]) & (b[0] & ~b[1])
    return zeros | ones, ones


def differ(a: Bits, b: Bits) -> Bits:
    """Exclusive or."""
    known = a[0] & b[0]
    return known, (a[1] ^ b[1]) & known


def add(a: Bits, b: Bits, carry: Bits) -> tuple[Bits, Bits]:
    """The sum and its carry.

    A bit of the sum is known where both bits are and the carry into it is the same for the
    smallest and for the largest operands.
    """
    low = least(a) + least(b) + carry[1]
    high = most(a) + most(b) + (carry[1] if carry[0] else 1)
    into_low = low ^ least(a) ^ least(b)  # the carries, where nothing unknown is set ...
    into_high = high ^ most(a) ^ most(b)  # ... and where all of it is
    same = ~(into_low ^ into_high)
    known = (a[0] & b[0] & same) & 255
    out = (low >> 8) & 1 if (low ^ high) >> 8 & 1 == 0 else None
    return (known, low & known), bit(None if out is None else bool(out))


def subtract(a: Bits, b: Bits, borrow: Bits) -> tuple[Bits, Bits]:
    """The difference and its borrow."""
    result, carry = add(a, complement(b), complement(borrow, 1))
    return result, complement(carry, 1)


def shift_left(value: Bits, count: int) -> Bits:
    """By a count modulo 256; zeros come in."""
    count = min(count & 255, 8)
    return (value[0] << count & 255) | ((1 << count) - 1), value[1] << count & 255


def shift_right(value: Bits, count: int) -> Bits:
    """By a count modulo 256; zeros come in."""
    count = min(count & 255, 8)
    return value[0] >> count | (0xFF00 >> count & 255), value[1] >> count


def equal(a: Bits, b: Bits) -> Bits:
    """Whether they are the same."""
    if (a[1] ^ b[1]) & a[0] & b[0]:
        return ZERO_BIT
    return ONE_BIT if a[0] & b[0] == 255 else UNKNOWN


def lower(a: Bits, b: Bits) -> Bits:
    """Whether a < b."""
    if most(a) < least(b):
        return ONE_BIT
    return ZERO_BIT if least(a) >= most(b) else UNKNOWN


def byte(value: Bits) -> Bits:
    """A bit as a byte."""
    return 254 | value[0], value[1]


def bit_of(value: Bits, index: int) -> Bits:
    """Bit number `index` modulo 8 of a byte."""
    return value[0] >> (index & 7) & 1, value[1] >> (index & 7) & 1


def select(condition: Bits, then: Bits, otherwise: Bits) -> Bits:
    """`then` where a bit is set, else `otherwise`."""
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
"""What is known besides where the first two arguments are the same."""


def transfer(op: str, *args: Bits | int, same: bool = False) -> Bits:
    """Return what is known of the result of an operation; nothing where its kind is not known.

    Args:
        op: its name in `npchip.isa.ir.OPERATIONS`.
        args: what is known of its arguments; of a constant its value.
        same: whether the first two arguments are certainly equal.
    """
    function = (_OF_SAME.get(op) if same else None) or OPERATIONS.get(op)
    return UNKNOWN if function is None else function(*args)
