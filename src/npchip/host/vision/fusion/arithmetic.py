"""Kinds of numbers that the algorithms of thesis 2.2 run on: real, integer, counted.

An algorithm is written once (`npchip.host.vision.fusion.algorithms`) with ``+ - * /`` and the few
operations of `Arithmetic`, which computes on float64 arrays. `Integers` computes on integers in Q
format, as the thesis simulates it (2.2.6), and finds every overflow. `Counting` computes on single
numbers and counts the operations (table 2.1).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from npchip.base.errors import InputError

Values = tuple[Any, ...]
Branch = Callable[[], Values]


# ---- real numbers


class Arithmetic:
    """Operations of an algorithm besides ``+ - * /``, here on float64 arrays without rounding."""

    def constant(self, value: float) -> Any:
        """Convert a constant of the rig."""
        return float(value)

    def pixels(self, value: ArrayLike) -> Any:
        """Convert offsets in pixels, multiples of half a pixel."""
        return np.asarray(value, np.float64)

    def words(self, value: ArrayLike) -> Any:
        """Convert entries of a table."""
        return value

    def narrow(self, value: Any) -> Any:
        """Round to the fraction bits of a word."""
        return value

    def shifted(self, value: Any, bits: int) -> Any:
        """Divide by 2 to the power of `bits` and round to a word."""
        return value / 2.0**bits

    def magnitude(self, value: Any) -> Any:
        """Return the value without its sign."""
        return np.abs(value)

    def choose(self, less: tuple[Any, Any], yes: Branch, no: Branch) -> Values:
        """Return yes() where less[0] < less[1], else no()."""
        first = less[0] < less[1]
        return tuple(np.where(first, a, b) for a, b in zip(yes(), no(), strict=True))


# ---- integers


@dataclass(frozen=True)
class QFormat:
    """Word lengths of integers in Q format.

    Attributes:
        fraction_bits: fraction of every word: 12 means steps of 1/4096 (thesis 2.2.6 says Q
            format, Q12 is a decision).
        word_bits: length of positions, u and quotients, with their sign.
        product_bits: length of products, sums of them and dividends, with their sign.

    Raises:
        InputError: NP507, lengths that make no sense or that 64 bits cannot hold.
    """

    fraction_bits: int = 12
    word_bits: int = 17
    product_bits: int = 29

    def __post_init__(self) -> None:
        """Check the lengths; see the class."""
        if not (
            1 <= self.fraction_bits <= 20
            and self.fraction_bits < self.word_bits <= 32
            and self.word_bits <= self.product_bits <= 40
        ):
            raise InputError(
                "NP507",
                f"Q format of {self.fraction_bits} fraction bits, {self.word_bits} to a word,"
                f" {self.product_bits} to a product: expected 1 to 20, more than that up to 32,"
                " and at least a word up to 40",
            )


Q12: Final = QFormat()
"""Shortest words for all algorithms in the fitted setting, whose positions reach 10.6 m."""

CHIP: Final = QFormat(12, 16, 24)
"""Word lengths of an NP: two bytes to a word, three to a product; positions within ±8 m."""


@dataclass(frozen=True, eq=False)
class Fixed:
    """Integers with a binary point.

    Attributes:
        raw: int64, shape (...): the value times 2 to the power of `fraction`.
        fraction: fraction bits.
        over: bool, shape (...): whether this value, or one that led to it, did not fit.
        kind: its arithmetic.
    """

    raw: NDArray[np.int64]
    fraction: int
    over: NDArray[np.bool_]
    kind: Integers

    def __add__(self, other: Fixed) -> Fixed:
        a, b, fraction = self._aligned(other)
        return self.kind.product(a + b, fraction, self.over | other.over)

    def __sub__(self, other: Fixed) -> Fixed:
        a, b, fraction = self._aligned(other)
        return self.kind.product(a - b, fraction, self.over | other.over)

    def __mul__(self, other: Fixed) -> Fixed:
        raw, fraction = self.raw * other.raw, self.fraction + other.fraction
        return self.kind.product(raw, fraction, self.over | other.over)

    def __truediv__(self, other: Fixed) -> Fixed:
        return self.kind.quotient(self, other)

    def __lt__(self, other: Fixed) -> NDArray[np.bool_]:
        a, b, _ = self._aligned(other)
        return np.asarray(a < b)

    def _aligned(self, other: Fixed) -> tuple[Any, Any, int]:
        fraction = max(self.fraction, other.fraction)
        a, b = self.raw << (fraction - self.fraction), other.raw << (fraction - other.fraction)
        return a, b, fraction


class Integers(Arithmetic):
    """Integers in Q format.

    Products keep all their bits; a result is rounded to the nearest (halves up) when it becomes a
    word again. Every word and every product is checked against its length: a value that does not
    fit is set to 0 and marked `over`, as is every result that depends on it.

    Args:
        form: the word lengths.

    Attributes:
        word_bits, product_bits: longest word and product seen so far, with its sign.
    """

    def __init__(self, form: QFormat = Q12) -> None:
        self.form = form
        self.word_bits = 0
        self.product_bits = 0

    def constant(self, value: float) -> Fixed:
        """Round a constant to the fraction bits of a word and drop trailing zeros."""
        raw, fraction = round(value * 2**self.form.fraction_bits), self.form.fraction_bits
        while fraction and not raw & 1:
            raw, fraction = raw >> 1, fraction - 1
        return self.product(np.array(raw), fraction, np.array(False))

    def pixels(self, value: ArrayLike) -> Fixed:
        """Convert offsets in pixels, multiples of a half, to one fraction bit."""
        raw = np.rint(2 * np.asarray(value, np.float64)).astype(np.int64)
        return Fixed(raw, 1, np.zeros(raw.shape, bool), self)

    def words(self, value: ArrayLike) -> Fixed:
        """Round entries of a table to words and mark those that do not fit."""
        raw = np.floor(np.ldexp(np.asarray(value, np.float64), self.form.fraction_bits) + 0.5)
        fits = np.abs(raw) < 2.0**40
        return self._word(np.where(fits, raw, 0).astype(np.int64), ~fits)

    def narrow(self, value: Fixed) -> Fixed:
        """Round to a word, halves up."""
        return self.shifted(value, 0)

    def shifted(self, value: Fixed, bits: int) -> Fixed:
        """Divide by 2 to the power of `bits` and round to a word, halves up."""
        drop = value.fraction + bits - self.form.fraction_bits
        raw = value.raw << -drop if drop <= 0 else (value.raw + (1 << (drop - 1))) >> drop
        return self._word(np.asarray(raw), value.over)

    def magnitude(self, value: Fixed) -> Fixed:
        """Return the value without its sign."""
        return Fixed(np.asarray(np.abs(value.raw)), value.fraction, value.over, self)

    def choose(self, less: tuple[Any, Any], yes: Branch, no: Branch) -> Values:
        """Return yes() where less[0] < less[1], else no(), rounded to words."""
        first, doubt = less[0] < less[1], less[0].over | less[1].over
        pairs = zip(map(self.narrow, yes()), map(self.narrow, no()), strict=True)
        return tuple(
            replace(
                a, raw=np.where(first, a.raw, b.raw), over=np.where(first, a.over, b.over) | doubt
            )
            for a, b in pairs
        )

    def product(self, raw: NDArray[np.int64], fraction: int, over: NDArray[np.bool_]) -> Fixed:
        """Make a product, checked against its length."""
        raw, over, self.product_bits = _checked(
            raw, over, self.form.product_bits, self.product_bits
        )
        return Fixed(raw, fraction, over, self)

    def quotient(self, a: Fixed, b: Fixed) -> Fixed:
        """Divide and round to a word, halves up; a division by 0 is marked."""
        up = self.form.fraction_bits - a.fraction + b.fraction
        over = a.over | b.over | (b.raw == 0)
        numerator, divisor = a.raw, np.where(over, 1, b.raw)
        if up >= 0:
            numerator = self.product(numerator << up, 0, over).raw
        else:
            divisor = divisor << -up
        return self._word(np.asarray((2 * numerator + divisor) // (2 * divisor)), over)

    def _word(self, raw: NDArray[np.int64], over: NDArray[np.bool_]) -> Fixed:
        raw, over, self.word_bits = _checked(raw, over, self.form.word_bits, self.word_bits)
        return Fixed(raw, self.form.fraction_bits, over, self)


def _checked(
    raw: NDArray[np.int64], over: NDArray[np.bool_], bits: int, most: int
) -> tuple[NDArray[np.int64], NDArray[np.bool_], int]:
    """Mark and clear what does not fit; return the longest length so far as well."""
    over = over | (raw < -(1 << (bits - 1))) | (raw >= 1 << (bits - 1))
    raw = np.where(over, 0, raw)
    if raw.size:
        ends = int(raw.min()), int(raw.max())
        most = max(most, *(max(value, ~value).bit_length() + 1 for value in ends))
    return raw, over, most


# ---- counted numbers


@dataclass(frozen=True)
class Counted:
    """A number whose operations are counted."""

    value: float
    kind: Counting

    def __add__(self, other: Counted) -> Counted:
        return self.kind.did("additions", self.value + other.value)

    def __sub__(self, other: Counted) -> Counted:
        return self.kind.did("additions", self.value - other.value)

    def __mul__(self, other: Counted) -> Counted:
        return self.kind.did("multiplications", self.value * other.value)

    def __truediv__(self, other: Counted) -> Counted:
        return self.kind.did("divisions", self.value / other.value)


@dataclass
class Counting(Arithmetic):
    """Single numbers whose operations are counted.

    Attributes:
        counts: numbers of additions, multiplications, divisions, shifts and comparisons.
            Subtractions are additions; signs, rounding and table look-ups are free.
    """

    counts: Counter[str] = field(default_factory=Counter)

    def did(self, what: str, value: float) -> Counted:
        """Count an operation and return its result."""
        self.counts[what] += 1
        return Counted(value, self)

    def constant(self, value: float) -> Counted:
        """Convert a constant of the rig."""
        return Counted(float(value), self)

    def pixels(self, value: ArrayLike) -> Counted:
        """Convert a single offset."""
        return Counted(float(np.asarray(value)), self)

    def shifted(self, value: Counted, bits: int) -> Counted:
        """Divide by 2 to the power of `bits`, counted as a shift."""
        return self.did("shifts", value.value / 2.0**bits)

    def magnitude(self, value: Counted) -> Counted:
        """Return the value without its sign."""
        return Counted(abs(value.value), self)

    def choose(self, less: tuple[Any, Any], yes: Branch, no: Branch) -> Values:
        """Return yes() or no() alone, counted as a comparison."""
        self.counts["comparisons"] += 1
        return yes() if less[0].value < less[1].value else no()
