"""Makes a program that fails smaller: lines go, one by one and many at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from tests.support.random_cases import Case

ATTEMPTS = 600
"""Programs that are tried at most."""


def shrink(case: Case, fails: Callable[[Case], bool], attempts: int = ATTEMPTS) -> Case:
    """The smallest case found that still fails.

    Args:
        case: fails.
        fails: whether a case fails; of a program that does not assemble it says no.
        attempts: how often it may be asked.
    """
    left = attempts

    def better(other: Case) -> bool:
        nonlocal left
        left -= 1
        return left >= 0 and fails(other)

    for change in _simpler(case):  # a low limit first: without a line a loop may be endless
        other = replace(case, **change)
        if better(other):
            case = other
    again = True
    while again and left > 0:
        again = False
        lines = case.text.splitlines()
        for remove in _removals(lines):
            other = replace(case, text=_without(lines, remove))
            if other.text and better(other):
                case, again = other, True
                break
    return case


def _simpler(case: Case) -> Iterator[dict[str, Any]]:
    yield from ({"limit": limit} for limit in (20_000, 2_000, 300) if limit < case.limit)
    yield {"states": 1}
    yield from ({"again": False}, {"hears": 0}, {"ring": 0}, {"tight": False})
    yield from ({"frames": frames} for frames in (1, 0) if frames < case.frames)


def _without(lines: Sequence[str], remove: set[int]) -> str:
    return "".join(f"{line}\n" for n, line in enumerate(lines) if n not in remove)


def _removals(lines: Sequence[str]) -> Iterator[set[int]]:
    """Sets of lines to try without, large ones first; then what only goes together."""
    size = len(lines) // 2
    while size:
        for start in range(0, len(lines), size):
            yield set(range(start, min(start + size, len(lines))))
        size //= 2
    open_regions: list[set[int]] = []
    for number, line in enumerate(lines):
        word = line.strip().split(" ")[0]
        if word in {"WHERE", ".rept"}:
            open_regions.append({number})
        elif word in {"ELSE", "END", ".endr"} and open_regions:
            open_regions[-1].add(number)
            if word != "ELSE":
                yield open_regions.pop()
        elif ":" in line:
            label = line.split(":")[0].strip()
            users = {n for n, other in enumerate(lines) if other.split()[-1:] == [label]}
            yield {number} | users
