"""Comparing shapes by the lengths of their sides, thesis 3.3.3, in plain integers.

``asm/recognise.s`` computes exactly this on the array, for triangles.

Between two key points lie y rows and x columns, or the other way round: y is the larger number.
The chip has neither squares nor roots, so the length of the side is

- ``thesis``: y + round(x/3), the thesis's approximation, halves rounded up: up to 8 % wrong;
- ``shifts``: max(y, y - floor(y/8) + floor(x/2)), without any division: up to 6 % (decision);
- ``exact``: the root, rounded, for comparison.

Two shapes are the same if they differ in scale, rotation and shift only. Lengths do not change with
a shift or a rotation, but the side that comes first does. The thesis begins with the shortest side
and scales it to be equal (`thesis_distance`): its errors then spread to all others, and if two
sides are about as short, the lists may begin differently. `distance` scales the longest side to
`UNIT` and takes the best of all rotations. Mirror images stay different, since key points are
listed clockwise.

Side lengths determine a triangle, but no polygon with more sides (3.3.3: "exception errors"): a
square and a rhombus have the same. The functions here take any number of sides within that limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import Final, Literal, NamedTuple

Length = Literal["thesis", "shifts", "exact"]

UNIT: Final = 128
"""Length of the longest side after scaling."""

TOLERANCE: Final = 8
"""Default for the largest distance of shapes that match, in parts of `UNIT`."""


class Match(NamedTuple):
    """The reference that is most like a shape.

    Attributes:
        number: its index in the references.
        distance: its distance from the shape, 0 to `UNIT`.
    """

    number: int
    distance: int


def length(rows: int, cols: int, how: Length = "shifts") -> int:
    """Return the length of a line over these rows and columns; their signs do not matter."""
    x, y = sorted((abs(rows), abs(cols)))
    match how:
        case "thesis":
            return y + (x + 1) // 3
        case "shifts":
            return max(y, y - (y >> 3) + (x >> 1))
        case "exact":
            return round(hypot(x, y))


def side_lengths(points: Sequence[tuple[int, int]], how: Length = "shifts") -> list[int]:
    """Return the lengths of the sides of a closed shape, from the first point to the second on."""
    after = [*points[1:], *points[:1]]
    return [
        length(b_row - a_row, b_col - a_col, how)
        for (a_row, a_col), (b_row, b_col) in zip(points, after, strict=True)
    ]


def scaled(lengths: Sequence[int]) -> list[int]:
    """Scale the longest side to `UNIT`, by a division that rounds down.

    Args:
        lengths: lengths, not all 0. The program has 7 bits for each.
    """
    longest = max(lengths)
    return [UNIT * side // longest for side in lengths]


def distance(a: Sequence[int], b: Sequence[int]) -> int | None:
    """Find the largest difference of two lists of scaled lengths, in their best rotation.

    Returns:
        0 to `UNIT`; None if the numbers of sides differ.
    """
    if len(a) != len(b):
        return None
    return min(
        max(abs(p - q) for p, q in zip(a, [*b[turn:], *b[:turn]], strict=True))
        for turn in range(len(b))
    )


def thesis_distance(a: Sequence[int], b: Sequence[int]) -> float | None:
    """Find the difference of two lists of lengths as 3.3.3 describes it.

    Both lists are rotated to begin with the (first) shortest side, and `a` is scaled to make these
    equal. The thesis does not say how the differences are joined; here they are added up.

    Returns:
        the sum in pixels of `b`; None if the numbers of sides differ.
    """
    if len(a) != len(b):
        return None
    first, second = a.index(min(a)), b.index(min(b))
    a, b = [*a[first:], *a[:first]], [*b[second:], *b[:second]]
    return sum(abs(p * b[0] / a[0] - q) for p, q in zip(a, b, strict=True))


def best_match(
    lengths: Sequence[int], references: Sequence[Sequence[int]], tolerance: int = TOLERANCE
) -> Match | None:
    """Find the reference that is most like a shape.

    Args:
        lengths: sides of the shape, in pixels.
        references: scaled sides of each reference.
        tolerance: largest distance of a match.

    Returns:
        the first one with the smallest distance; None if that is above the tolerance.
    """
    shape = scaled(lengths)
    differences = ((distance(shape, reference), k) for k, reference in enumerate(references))
    near = [(found, k) for found, k in differences if found is not None and found <= tolerance]
    return Match(*min(near)[::-1]) if near else None
