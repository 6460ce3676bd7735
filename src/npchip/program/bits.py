"""Bytes of which some bits are known: what can be said of a register without running a program.

A byte is a pair (which bits are known, their values). A bit is the same with one bit.
"""

from __future__ import annotations

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
    """By 0 to 8 places; zeros come in."""
    return (value[0] << count & 255) | ((1 << count) - 1), value[1] << count & 255


def shift_right(value: Bits, count: int) -> Bits:
    """By 0 to 8 places; zeros come in."""
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
