"""Parts that the plans of a program share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from npchip.kernels.code import Code, Register, line
from npchip.kernels.finish import Finish, finished
from npchip.kernels.numbers import Arithmetic
from npchip.kernels.strip import Strip
from npchip.kernels.sums import Term, formula

PIXELS = 8
"""Pixels in a row and in a column of an NP."""
CDS_WORDS = 6
ROW_NAMES = {-2: "n2", -1: "n1", 0: "c", 1: "s1", 2: "s2"}
"""Names of the rows around the one to be computed, by their distance from it."""
PLACE = "place"


class Section(NamedTuple):
    """Lines of a program that are executed together.

    Attributes:
        lines: the source.
        times: how often in a frame.
    """

    lines: tuple[str, ...]
    times: int

    @property
    def words(self) -> int:
        """Instructions in it."""
        return sum(words_of(text) for text in self.lines)


class Plan(NamedTuple):
    """A program for some kernels.

    Attributes:
        name: how it goes about it.
        signal: bank of the signal samples.
        reset: bank of the reset samples.
        registers: names of registers that are not called by number.
        sections: the program behind its two conversions.
        down: sums down a column, with their names.
        along: sums along a row, with their names.
        additions: numbers added or subtracted for each pixel, in the mean.
    """

    name: str
    signal: int
    reset: int
    registers: Mapping[str, str]
    sections: tuple[Section, ...]
    down: tuple[tuple[str, Sequence[Term]], ...]
    along: tuple[tuple[str, Sequence[Term]], ...]
    additions: float

    @property
    def formulas(self) -> tuple[str, ...]:
        """The sums, written down."""
        down = (f"{name}(y) = {formula(terms, 'y')}" for name, terms in self.down)
        along = (f"{name}(x) = {formula(terms, 'x')}" for name, terms in self.along)
        return (*down, *along)

    @property
    def words(self) -> int:
        """Words of the program, with its expose, its conversions and its last jump."""
        return 4 + sum(section.words for section in self.sections)

    @property
    def steps(self) -> int:
        """Instructions executed for a frame behind the conversions."""
        return sum(section.words * section.times for section in self.sections)


def words_of(text: str) -> int:
    """Instructions that a line of a program stands for."""
    text = text.partition(";")[0].strip()
    if text.startswith("."):
        text = text.partition(":")[2].strip()
    if text.startswith("cds "):
        return CDS_WORDS
    return 1 if text else 0


def registers_for(names: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """Give the last registers names; return these, and the registers that are left."""
    named = {name: f"r{15 - number}" for number, name in enumerate(names)}
    return named, [f"r{number}" for number in range(16 - len(names))]


def loop(label: str, lines: Sequence[str], pointer: str, end: int, times: int) -> Section:
    """A loop around lines that move a pointer on to its end."""
    closing = (line(f"CMP {pointer}, #{end}"), line(f"JANY LO, {label}"))
    return Section((f"{label}:", *lines, *closing), times)


def corrected(code: Code) -> Register:
    """Write the code that reads the pixel at the pointer: signal - reset, at least 0."""
    register, spare = code.new(), code.new()
    code.add(f"cds {{0}}, {code.pointer}, {{1}}", register, spare, made=[register, spare])
    return register


def send(do: Arithmetic, strip: Strip, finishes: Sequence[Finish], place: int) -> None:
    """Write the code that computes and sends the results at a place, each to its port."""
    for port, how in enumerate(finishes):
        number, own = strip.result(how.kernel.name, place, how.constant)
        byte = finished(do, how, number, own=own)
        do.code.add(f"OUT {port}, {{0}}", byte)


def reach(finishes: Sequence[Finish]) -> tuple[int, int]:
    """Return how many pixels the kernels reach up and down, and how many to the sides."""
    taken = [(y, x) for how in finishes for y, x, weight in how.kernel.placed() if weight]
    return max(abs(y) for y, _ in taken), max(abs(x) for _, x in taken)
