"""The natural order of file names, with numbers below zero and time stamps."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from decimal import Decimal
from pathlib import Path

from natsort import natsorted, ns

_COUNTED = re.compile(r"(-?)([0-9]+)")
_TIMED = re.compile(r"(-?)((?<![0-9.])[0-9]+\.[0-9]+(?![.0-9])|[0-9]+)")
"""Signs and numbers; timed ones may have digits behind a point."""


def in_order(paths: Sequence[Path]) -> list[Path]:
    """Sort file names in natural order: 2 before 10, -2 before -1, 0.25 before 0.5.

    A minus is a sign if it follows a mark such as ``_`` (``img_-1``), or if a name has a digit in
    its place (``t-1`` beside ``t0``). Digits behind a single point are a fraction, as in a time
    stamp, unless lengths differ and one of them ends in 0: then ``1.10`` follows ``1.9``.
    """
    names = {part for path in paths for part in _parts(path)}
    numbers = _TIMED if _fractions(names) else _COUNTED
    unsigned = {name[: found.start()] for name in names for found in re.finditer("[0-9]+", name)}

    def key(path: Path) -> list[list[str | Decimal]]:
        return [*(split(part) for part in _parts(path)), [path.suffix]]

    def split(name: str) -> list[str | Decimal]:
        pieces: list[str | Decimal] = []
        end = 0
        for found in numbers.finditer(name):
            before = name[: found.start()]
            signed = found[1] and (before[-1:] in "_=,;:(+" or before in unsigned)
            start = found.start() if signed else found.start(2)
            pieces += [name[end:start], Decimal(name[start : found.end()])]
            end = found.end()
        return [*pieces, name[end:]]

    # Sorted twice: names that are equal in natural order keep a fixed order too.
    return natsorted(sorted(paths), key=key, alg=ns.IGNORECASE)


def _parts(path: Path) -> tuple[str, ...]:
    return *path.parent.parts, path.stem


def _fractions(names: Iterable[str]) -> bool:
    """Tell fractions from numbers of their own by zeros at their ends, which a fraction drops."""
    behind = [found[2].partition(".")[2] for name in names for found in _TIMED.finditer(name)]
    lengths = {len(digits) for digits in behind if digits}
    return len(lengths) <= 1 or not any(len(d) > 1 and d.endswith("0") for d in behind)
