"""Folding of macros, repetitions, conditions, masked regions, and long comments."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, Literal, NamedTuple

from npchip.assembler.blocks import CLOSERS
from npchip.isa import Isa
from npchip.language.lines import BRANCHES, ENDS, opened, view

_LEAST: Final = 3
"""Fewest lines of a comment that can be folded."""


class Fold(NamedTuple):
    """Lines that can be folded, from 1, both included."""

    first: int
    last: int
    kind: Literal["region", "comment"]


def folds(lines: Sequence[str], isa: Isa) -> list[Fold]:
    """Return what can be folded in a file."""
    return sorted([*_blocks(lines), *_masks(lines, isa), *_comments(lines)])


def _blocks(lines: Sequence[str]) -> Iterator[Fold]:
    open_: list[tuple[str, int]] = []
    for number, line in enumerate(lines, 1):
        word = view(line).word
        if word in CLOSERS:
            open_.append((CLOSERS[word], number))
        elif word in BRANCHES and open_ and open_[-1][0] == ".endif":
            yield from _region(open_[-1][1], number - 1)
            open_[-1] = (".endif", number)
        elif word in ENDS and any(closer == word for closer, _ in open_):
            while open_[-1][0] != word:
                open_.pop()
            yield from _region(open_.pop()[1], number)


def _masks(lines: Sequence[str], isa: Isa) -> Iterator[Fold]:
    effects = opened(isa)
    open_: list[int] = []
    for number, line in enumerate(lines, 1):
        word = view(line).word
        change = None if word.startswith(".") else effects.get(word.upper())
        if change == 1:
            open_.append(number)
        elif change == 0 and open_:
            yield from _region(open_[-1], number - 1)
            open_[-1] = number
        elif change == -1 and open_:
            yield from _region(open_.pop(), number)
        elif word in {".macro", ".endm"}:
            open_.clear()


def _region(first: int, last: int) -> Iterator[Fold]:
    if last > first:
        yield Fold(first, last, "region")


def _comments(lines: Sequence[str]) -> Iterator[Fold]:
    first = None
    for number, line in enumerate([*lines, ""], 1):
        if line.lstrip().startswith(";"):
            first = first or number
        elif first is not None:
            if number - first >= _LEAST:
                yield Fold(first, number - 1, "comment")
            first = None
