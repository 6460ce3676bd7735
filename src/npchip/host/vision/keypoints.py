"""Key points of simple shapes, thesis 3.3.1 and 3.3.2, in plain integers.

``asm/keypoints.s`` and ``asm/keypoints_farthest.s`` compute exactly this on the array. The thesis
leaves some points open; they are decided here, for the figures that
``tests/host/vision/test_keypoints.py`` measures. Pixels are (row, column); everything outside the
frame is background; two pixels are neighbours if they share a side.

**Edge tracer** (`trace_edges`, figure 3.1). It enters an object on its first pixel, heading east,
and moves to the first of the left, straight, right and backward neighbours that belongs to the
object. That keeps the outside on its left: it goes round the object clockwise, and round a hole
anticlockwise. The trace closes when it leaves the first pixel in the same direction again.

**Scan tracer** (`trace_edges`, figure 3.4). It looks at the rows from the top, at each from left to
right, for an object pixel that is not marked. The edge tracer marks the pixels that it visits.
After a marked pixel whose right neighbour is an unmarked object pixel, the scan tracer ignores all
pixels up to the next marked one: the inside of a known object. After a trace it looks at the same
row again from its start (decision: the array sees a row at once, and the trace has marked new
pixels); it never goes back to an earlier row. Traces of fewer than `SHORTEST` steps are dropped
(decision; 3.3.4 asks for a threshold). Each trace marks at least one pixel and closes, so the scan
ends.

**Key points** (`key_points`). A side of the shape is a way that needs at most two directions. A new
side begins at a step

- in a *third direction*, or one that *reverses* the step before (figure 3.2): the key point is the
  pixel from which the step is made;
- at which both the present run and the one before have two steps or more. A run is a number of
  steps in one direction. A straight line has runs of a single step in at least one direction, so
  this is a *bend* between two sides with the same two directions (our reading of "the numbers of
  pixels in the two directions are stored and compared");
- at which the present run becomes `RATIO` times as long as the first complete run of this side in
  its direction, or which ends a run that is `RATIO` times as short (the *run-length rule* of 3.3.2
  for obtuse corners, figure 3.3). A ratio of 3 implies a difference of 2.

In the last two cases the tracer has passed the corner: the key point is *dated back* to the pixel
where the present or just completed run began. The new side begins with the step itself, as a run of
one. The first run of a side may have begun before it, so its length is no measure for later ones.

The start pixel is not a key point. The tracer goes on until it finds the first key point, and from
there once round until it makes the same step again; only key points of this round count. A key
point within `MERGE` rows and columns of the one kept before it is the same corner and dropped. At
most `MOST_POINTS` are kept. At the end the last ones are dropped that are as close to the first.

**Farthest points** (`farthest_points`) takes the only object for a triangle, and traces nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Frame = NDArray[np.uint8]
Mask = NDArray[np.bool_]

SHORTEST: Final = 8
"""Fewest steps of a trace that counts as an object."""

RATIO: Final = 3
"""Ratio of run lengths that tells two sides apart."""

MERGE: Final = 3
"""Rows and columns within which two key points are the same corner."""

MOST_POINTS: Final = 32
"""Most key points of an object."""

SEARCHES: Final = 6
"""Searches for a farthest point: three, and each point once more."""

_MOVES: Final = ((-1, 0), (0, 1), (1, 0), (0, -1))
_LEFT_UP_RIGHT_DOWN: Final = (3, 0, 1, 2)
_EAST: Final = 1


class Point(NamedTuple):
    """A pixel."""

    row: int
    col: int


class Step(NamedTuple):
    """A step of the edge tracer: the pixel that it leaves, and its direction.

    Attributes:
        row, col: the pixel.
        direction: 0 north, 1 east, 2 south, 3 west.
    """

    row: int
    col: int
    direction: int


@dataclass(frozen=True)
class Reading:
    """A reading of the thesis's text: the rules of the key points.

    Attributes:
        laps: 1 if the start pixel is a key point and the tracer goes round once; 2 as above.
        reversal: whether a reversed step makes a key point.
        bend: whether two long runs make a key point.
        ratio: ratio of the run-length rule; 0 without it.
        merge: rows and columns within which key points are the same; -1 without merging.
    """

    laps: int = 2
    reversal: bool = True
    bend: bool = True
    ratio: int = RATIO
    merge: int = MERGE


LITERAL: Final = Reading(laps=1, reversal=False, bend=False, ratio=0, merge=-1)
"""The rules of 3.3.1 alone (figure 3.1)."""

REVERSAL: Final = Reading(bend=False, ratio=0)
"""The rules with the reversal of figure 3.2, from the first key point on."""

RUN_LENGTHS: Final = Reading(bend=False)
"""The rules with the run lengths of figure 3.3."""

BEST: Final = Reading()
"""All rules, as in ``asm/keypoints.s``."""


def object_mask(frame: Frame, threshold: int = 128, *, dark: bool = False) -> Mask:
    """Return the object pixels: those of `threshold` or more, or if `dark` those below it."""
    bright: Mask = frame >= threshold
    return ~bright if dark else bright


# ---- tracers


def trace_edges(mask: Mask, shortest: int = SHORTEST) -> list[list[Step]]:
    """Trace the edges of all objects (3.3.1, 3.3.2).

    Args:
        mask: bool, shape (rows, columns): object pixels.
        shortest: fewest steps of a trace that is kept.

    Returns:
        the steps of one round for each trace, in the order of the scan.
    """
    inside = np.pad(mask, 1).tolist()  # a border of background
    marked = [[False] * len(row) for row in inside]
    traces = []
    for row in range(1, len(inside) - 1):
        while (col := _candidate(inside[row], marked[row])) is not None:
            steps = list(_round(inside, row, col))
            marked[row][col] = True
            for step in steps:
                marked[step.row][step.col] = True
            if len(steps) >= shortest:
                traces.append([Step(r - 1, c - 1, d) for r, c, d in steps])
    return traces


def _candidate(inside: Sequence[bool], marked: Sequence[bool]) -> int | None:
    """Return the column of the first pixel of a row from which to trace."""
    ignore = False
    for col in range(1, len(inside) - 1):
        if marked[col]:
            ignore = inside[col + 1] and not marked[col + 1]
        elif inside[col] and not ignore:
            return col
    return None


def _round(inside: Sequence[Sequence[bool]], row: int, col: int) -> Iterator[Step]:
    """Yield the steps of the edge tracer from a pixel once round; none without a neighbour."""
    heading, first = _EAST, None
    while True:
        for turn in _LEFT_UP_RIGHT_DOWN:
            direction = (heading + turn) % 4
            down, right = _MOVES[direction]
            if inside[row + down][col + right]:
                break
        else:
            return
        step = Step(row, col, direction)
        if step == first:
            return
        first = first or step
        yield step
        row, col, heading = row + down, col + right, direction


# ---- key points of a trace


class _Side:
    """The present side of the shape."""

    def __init__(self, step: Step, reading: Reading) -> None:
        self._reading = reading
        self._stored = {step.direction}
        self._run_start = Point(step.row, step.col)
        self._direction = step.direction
        self._run = 1  # steps of the present run ...
        self._before = 0  # ... and of the one before
        self._first_runs = [0, 0]  # first complete runs, vertical and horizontal; 0: none yet

    def key_point(self, step: Step) -> Point | None:
        """Take a step and return the key point if a new side has begun."""
        here = Point(step.row, step.col)
        ratio = self._reading.ratio
        first = self._first_runs[self._direction % 2]
        if step.direction == self._direction:
            self._run += 1
            bend = self._reading.bend and min(self._run, self._before) >= 2
            longer = ratio and first and self._run >= ratio * first
            return self._run_start if bend or longer else None
        reverse = (step.direction - self._direction) % 4 == 2
        third = len(self._stored) == 2 and step.direction not in self._stored
        if third or (reverse and self._reading.reversal):
            return here
        if self._before:  # the first run of a side may be only a part
            if ratio and first and first >= ratio * self._run:
                return self._run_start
            self._first_runs[self._direction % 2] = first or self._run
        self._stored.add(step.direction)
        self._before, self._run = self._run, 1
        self._direction, self._run_start = step.direction, here
        return None


def key_points(steps: Sequence[Step], reading: Reading = BEST) -> list[Point]:
    """Find the key points of one closed trace (3.3.1, 3.3.2).

    Args:
        steps: one round of `trace_edges`, not empty.
        reading: the rules.

    Returns:
        key points in the order of the trace: clockwise for an object.
    """
    if reading.laps == 1:
        found = [point for _, point in _corners(steps, reading)]
        return _merged([Point(*steps[0][:2]), *found], reading.merge)
    corners = _corners([*steps, *steps, *steps], reading)
    last = next(corners)[0] + len(steps)
    return _merged(
        [point for _, point in takewhile(lambda c: c[0] <= last, corners)], reading.merge
    )


def _corners(steps: Sequence[Step], reading: Reading) -> Iterator[tuple[int, Point]]:
    """Yield every key point, with the number of the step that shows it."""
    side = _Side(steps[0], reading)
    for index, step in enumerate(steps[1:], 1):
        point = side.key_point(step)
        if point is not None:
            yield index, point
            side = _Side(step, reading)


def _merged(points: Sequence[Point], distance: int) -> list[Point]:
    """Drop points close to the last one kept, then last ones close to the first."""
    kept: list[Point] = []
    for point in points:
        if not (kept and _close(point, kept[-1], distance)) and len(kept) < MOST_POINTS:
            kept.append(point)
    while len(kept) > 1 and _close(kept[0], kept[-1], distance):
        kept.pop()
    return kept


def _close(a: Point, b: Point, distance: int) -> bool:
    return abs(a.row - b.row) <= distance and abs(a.col - b.col) <= distance


def find_key_points(mask: Mask, reading: Reading = BEST) -> list[list[Point]]:
    """Find the key points of every object, in the order of the scan tracer."""
    return [key_points(steps, reading) for steps in trace_edges(mask)]


# ---- farthest points


def farthest_points(mask: Mask, searches: int = SEARCHES) -> list[Point]:
    """Find three corners of an object without tracing it (decision: not in the thesis).

    All object pixels of the frame count as one object. Each search takes the pixel R that is
    farthest from the line through the last two points P and Q, by the size of the cross product
    (R - P) x (Q - P), and appends it. The first two points are (0, 0) and (1, 0), the left edge of
    the frame. So A is the rightmost pixel, B the one farthest from a line to it, C the one farthest
    from AB, and by default three more searches refine A, B and C. The distance from a line is
    convex, so the farthest pixel of a triangle lies at one of its corners.

    The last one in the order of the scan wins among equally far pixels. Cross products are at most
    (rows - 1)(columns - 1) in size; the program has 15 bits for them.

    Args:
        mask: bool, shape (rows, columns).
        searches: number of searches, at least 3; the last three points are the result.

    Returns:
        the three points; none without an object.
    """
    rows, cols = (axis.astype(np.int64) for axis in np.nonzero(mask))
    if not len(rows):
        return []
    points = [Point(0, 0), Point(1, 0)]
    for _ in range(searches):
        p, q = points[-2:]
        distances = abs((rows - p.row) * (q.col - p.col) - (cols - p.col) * (q.row - p.row))
        last = int(np.flatnonzero(distances == distances.max())[-1])
        points.append(Point(int(rows[last]), int(cols[last])))
    return points[-3:]
