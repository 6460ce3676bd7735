"""Corners of convex shapes by their outlines, in plain integers (decision: not in the thesis).

``asm/polygons.s`` computes exactly this on the array. The tracers of `npchip.host.vision.keypoints`
judge a corner by steps of one pixel, and miss blunt ones. Here a corner is the pixel of an object
that is farthest from a line between two others, as in `farthest_points`, but for any number of
corners. Pixels are (row, column); everything outside the frame is background.

**Objects** (`objects`). An object is the object pixels that are connected by their sides. What lies
in its holes belongs to other objects: a ring with a square in it is two.

**Sides** (`corners`). The outline begins with two corners, the first pixel in the order of the scan
and one in the lowest row. Between two corners P and Q, the pixel R that is farthest out from the
line P Q is a new corner if it is at least `TOLERANCE` lengths of P Q away, by the cross product

    (R.col - P.col) * (Q.row - P.row) - (R.row - P.row) * (Q.col - P.col)

which is the distance times the length; the length is that of `shapes.length`, without roots. Then P
R and R Q are searched in the same way. Dents and holes do not show: an outline is convex.

**Laps** (`corners`). The first two corners may lie anywhere on a level side, and one true corner
may be found as two. So the outline is gone round `LAPS` times: a corner within `MERGE` rows and
columns of the next one is dropped, and any other becomes the farthest pixel from the line between
the corners beside it, or is dropped if none is far enough. Fewer than three corners are no object.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from npchip.host.vision.keypoints import Point
from npchip.host.vision.shapes import length

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from npchip.host.vision.keypoints import Mask

TOLERANCE: Final = 2
"""Least distance in pixels of a corner from the line between those beside it."""

MERGE: Final = 4
"""Rows and columns within which two corners are one."""

LAPS: Final = 2
"""Number of times that every corner is looked at again."""

MOST_CORNERS: Final = 32
"""Most corners of an object that are found at first."""


def objects(mask: Mask) -> Iterator[Mask]:
    """Yield the pixels of each object, in the order of their first pixels.

    Args:
        mask: bool, shape (rows, columns): object pixels.

    Yields:
        bool, the same shape.
    """
    free = np.pad(mask, 1)
    for row, col in np.argwhere(free).tolist():
        if free[row, col]:
            found = np.zeros_like(free)
            edge = [(row, col)]
            free[row, col] = False
            while edge:
                r, c = edge.pop()
                found[r, c] = True
                for beside in ((r - 1, c), (r + 1, c), (r, c - 1), (r, c + 1)):
                    if free[beside]:
                        free[beside] = False
                        edge.append(beside)
            yield found[1:-1, 1:-1]


class _Search:
    """The searches for the pixels of one object."""

    def __init__(self, mask: Mask, tolerance: int) -> None:
        self._rows, self._cols = (axis.astype(np.int64) for axis in np.nonzero(mask))
        self._tolerance = tolerance
        self.first = Point(int(self._rows[0]), int(self._cols[0]))

    def farthest(self, p: Point, q: Point) -> Point | None:
        """Return the pixel farthest out from the line, of equals the last one in the scan."""
        down, right = q.row - p.row, q.col - p.col
        away: NDArray[np.int64] = (self._cols - p.col) * down - (self._rows - p.row) * right
        most = int(away.max())
        if most < self._tolerance * length(down, right):
            return None
        last = int(np.flatnonzero(away == most)[-1])
        return Point(int(self._rows[last]), int(self._cols[last]))


def corners(
    mask: Mask, tolerance: int = TOLERANCE, merge: int = MERGE, laps: int = LAPS
) -> list[Point]:
    """Find the corners of one object's outline.

    Args:
        mask: bool, shape (rows, columns): the pixels of the object, at least one.
        tolerance: least distance of a corner from the line between those beside it, in pixels.
        merge: rows and columns within which two corners are one.
        laps: how often every corner is looked at again.

    Returns:
        the corners, clockwise; none if there are fewer than three.
    """
    search = _Search(mask, tolerance)
    begin = search.first
    lowest = search.farthest(Point(begin.row, begin.col + 1), begin)
    if lowest is None:
        return []
    found: list[Point] = []
    p, ahead = begin, [begin, lowest]  # the next corner is the last one
    while ahead:
        between = search.farthest(p, ahead[-1])
        if between is not None and len(found) + len(ahead) < MOST_CORNERS:
            ahead.append(between)
        else:
            p = ahead.pop()
            found.append(p)
    for _ in range(laps):
        found = _lap(search, found, merge)
    return found if len(found) > 2 else []


def _lap(search: _Search, found: Sequence[Point], merge: int) -> list[Point]:
    """Look at every corner again, with those beside it as they are by then."""
    kept: list[Point] = []
    for number, corner in enumerate(found, 1):
        q = found[number] if number < len(found) else (kept or found)[0]
        if max(abs(corner.row - q.row), abs(corner.col - q.col)) > merge:
            between = search.farthest((kept or found)[-1], q)
            if between is not None:
                kept.append(between)
    return kept


def is_regular(found: Sequence[Point]) -> bool:
    """Return whether all sides are about as long as each other, and all angles as wide.

    The shortest side must have 11/16 of the longest; angles are judged by the lengths from each
    corner to the one after the next, in the same way.
    """
    for apart in (1, 2):
        after = [*found[apart:], *found[:apart]]
        lengths = [length(q.row - p.row, q.col - p.col) for p, q in zip(found, after, strict=True)]
        longest = max(lengths)
        if min(lengths) < longest - (longest >> 2) - (longest >> 4):
            return False
    return True


def find_outlines(mask: Mask) -> list[list[Point]]:
    """Find the corners of all objects that have at least three."""
    return [found for each in objects(mask) if (found := corners(each))]
