"""Rows of cells as columns of text."""

from __future__ import annotations

from collections.abc import Sequence


def aligned(rows: Sequence[Sequence[str]], *, titled: bool = True) -> list[str]:
    """Return a line for each row, its cells to the right, two blanks apart.

    Args:
        rows: cells, as many in each.
        titled: the first cell of a row is its title, which stands to the left.
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if titled and not number else cell.rjust(width)
            for number, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
