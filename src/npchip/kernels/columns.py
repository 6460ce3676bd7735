"""Kernels as sums along the rows of sums down the columns.

Two columns of kernels that differ by a factor count as one. Or the sums of a column are just its
pixels: three bytes, of which every 3 x 3 kernel can be made.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import gcd
from typing import NamedTuple

from npchip.kernels.finish import Finish
from npchip.kernels.parts import ROW_NAMES, reach
from npchip.kernels.sums import Sums, share

BANKS = (0, 128, 64, 192)
"""Banks for the sums of columns, a byte in each, in this order."""

Column = tuple[int, ...]


class Columns(NamedTuple):
    """The kernels as sums along the rows of sums of columns.

    Attributes:
        columns: weights of each sum of a column, from north to south, by name.
        rows: for each kernel the weights of these sums, by name and distance.
    """

    columns: dict[str, Column]
    rows: dict[str, dict[tuple[str, int], int]]


class Passes(NamedTuple):
    """The two passes of a program.

    Attributes:
        banks: where each sum of a column is stored, the bank of each of its bytes.
        down: the sums of the first pass.
        along: the sums of the second.
    """

    banks: dict[str, tuple[int, ...]]
    down: Sums
    along: Sums


def pixels_of(finishes: Sequence[Finish]) -> Columns:
    """Take the pixels of a column as its sums, each of them a pixel."""
    down, _ = reach(finishes)
    names = {y: ROW_NAMES[y] for y in range(-down, down + 1)}
    rows = {
        how.kernel.name: {(names[y], x): weight for y, x, weight in how.kernel.placed() if weight}
        for how in finishes
    }
    used = {name for row in rows.values() for name, _ in row}
    return Columns(
        {
            name: tuple(int(y == other) for other in names)
            for y, name in names.items()
            if name in used
        },
        rows,
    )


def columns_of(finishes: Sequence[Finish]) -> Columns:
    """Find the columns that kernels consist of, up to a factor."""
    names: dict[Column, str] = {}
    rows: dict[str, dict[tuple[str, int], int]] = {}
    size = max(how.kernel.size for how in finishes)
    for how in finishes:
        weights = how.kernel.weights
        margin = (0,) * ((size - len(weights)) // 2)
        row = rows[how.kernel.name] = {}
        for x, column in enumerate(zip(*weights, strict=True)):
            factor = gcd(*column)
            if factor:
                factor *= -1 if sum(column) < 0 else 1
                prime = (*margin, *(weight // factor for weight in column), *margin)
                opposite = tuple(-weight for weight in prime)
                if opposite in names:
                    prime, factor = opposite, -factor
                name = names.setdefault(prime, f"v{len(names) + 1}")
                row[name, x - len(weights) // 2] = factor
    return Columns({name: prime for prime, name in names.items()}, rows)


def passes_of(columns: Columns, width: int, *, split: bool) -> Passes | None:
    """Give the sums of columns their places, and find what the sums of both passes share.

    Args:
        columns: the kernels.
        width: bytes of a sum, 1 or 2; a pixel is one byte in any case.
        split: as in `share`.

    Returns:
        The passes; None if the sums of columns need more than `BANKS`.
    """
    sizes = {name: 1 if _is_byte(column) else width for name, column in columns.columns.items()}
    if sum(sizes.values()) > len(BANKS):
        return None
    free = iter(BANKS)
    banks = {name: tuple(next(free) for _ in range(size)) for name, size in sizes.items()}
    down = {
        name: {("p", y - len(column) // 2): weight for y, weight in enumerate(column) if weight}
        for name, column in columns.columns.items()
    }
    return Passes(banks, share(down, "a", split=split), share(columns.rows, "b", split=split))


def _is_byte(column: Column) -> bool:
    """True if the sum of a column is a pixel."""
    return min(column) >= 0 and sum(column) == 1
