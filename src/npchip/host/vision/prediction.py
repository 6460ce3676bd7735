"""Trajectory calculation and prediction of thesis 2.1 in plain integers.

The programs ``asm/trajectory*.s`` compute exactly this on the array. In thesis 2.1.2 x(k) is the
centre in frame k along one axis, and

    v      = x(k-1) - x(k-2)            (2.1a)  the *older* of the last two displacements
    a      = x(k) - x(k-1) - v          (2.1b)  the change of the displacement
    x(k+1) = x(k) + v + 2a              (2.1c)  = 3 x(k) - 3 x(k-1) + x(k-2)

(2.1c) is exact for a constant acceleration: the newest displacement is v + a, the next v + 2a.
To look further ahead it is iterated with a constant a: each step adds a to the displacement and
that to the position, so x(k+s) = x(k) + s (v + a) + s (s + 1)/2 a.

Integers, as on the chip:

- Centres are bytes, 0 to size - 1 with a size of up to 256. Displacements (within ±255),
  accelerations (±510), their changes (±1,020) and positions are signed 16-bit numbers that never
  wrap: the largest position, 255 + 255 s + 510 s (s + 1)/2, stays below 2^15 up to s = `MAX_STEPS`.
- Only the predicted position is brought back into the frame, 0 to size - 1, after the last step.
- k counts *valid* frames: where nothing moves there is no centre, nothing is predicted, and the
  history waits unchanged (decision, as the contract of ``asm/trajectory.s`` has it).
- What is not known yet counts as unchanged (decision): the first centre as at rest (it is
  repeated), the first displacement as one without acceleration (a straight line).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]
    Centers = NDArray[np.int64]

MAX_STEPS: Final = 10
"""Most steps ahead for which no position leaves 16 bits, whatever the centres are."""

FRAME: Final = (64, 80)
"""Rows and columns of the thesis's frame."""


# ---- 2.1.1: where the object is


def moving_centers(frames: Frames, threshold: int = 32) -> list[tuple[int, int] | None]:
    """Centre of the bounding box of the pixels that change (thesis 2.1.1).

    The box spans the object's last and present place, so the centre lies between them.

    Args:
        frames: uint8, shape (T, rows, columns).
        threshold: least change of a pixel that moves.

    Returns:
        for each frame (row, column), means of first and last rounded down; None where nothing
        moves and in the first frame.
    """
    found: list[tuple[int, int] | None] = [None] * min(len(frames), 1)
    for before, frame in pairwise(frames):
        moving = np.abs(frame.astype(np.int16) - before) >= threshold
        rows = np.flatnonzero(moving.any(axis=1))
        cols = np.flatnonzero(moving.any(axis=0))
        if len(rows):
            found.append((int(rows[0] + rows[-1]) >> 1, int(cols[0] + cols[-1]) >> 1))
        else:
            found.append(None)
    return found


# ---- 2.1.2: where it will be


def linear(x0: int, x1: int, steps: int = 1) -> int:
    """Continue on a straight line: x0 newest, x1 before it; not clamped to the frame."""
    return x0 + steps * (x0 - x1)


def second_order(x0: int, x1: int, x2: int, steps: int = 1) -> int:
    """Continue with constant acceleration, equations (2.1a-c), `steps` times; not clamped.

    Args:
        x0: newest centre, x(k).
        x1: x(k-1).
        x2: x(k-2).
        steps: frames ahead.
    """
    v = x1 - x2  # (2.1a)
    a = x0 - x1 - v  # (2.1b)
    for _ in range(steps):
        x0, v = x0 + v + 2 * a, v + a  # (2.1c); v becomes the older displacement of the next step
    return x0


def robust(x0: int, x2: int, x4: int) -> int:
    """Continue the parabola through every second centre, rounded half up; not clamped.

    As exact as (2.1c) for constant acceleration, but rounding errors of the centres are amplified
    by sqrt(334)/8 = 2.3 rather than sqrt(19) = 4.4 (decision; see docs/prediction.md).

    Args:
        x0: newest centre, x(k).
        x2: x(k-2).
        x4: x(k-4).
    """
    return (15 * x0 - 10 * x2 + 3 * x4 + 4) >> 3


def clamp(value: int, size: int) -> int:
    """Bring a position into a frame of `size` rows or columns."""
    return min(max(value, 0), size - 1)


class Step(NamedTuple):
    """What a predictor says of one axis after a centre.

    Attributes:
        predicted: expected centre, within the frame.
        inflection: the motion has changed here, so `predicted` repeats the centre.
    """

    predicted: int
    inflection: bool = False


class AxisPredictor(Protocol):
    """Predicts one axis, centre by centre."""

    def update(self, center: int) -> Step:
        """Take the next valid centre."""


@dataclass
class LinearPredictor:
    """First order: what ``asm/trajectory.s`` does in each axis.

    Attributes:
        size: rows or columns of the frame.
        steps: frames ahead.
    """

    size: int
    steps: int = 1
    _last: int | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        _check(self.size, self.steps)

    def update(self, center: int) -> Step:
        """Take the next valid centre."""
        last = center if self._last is None else self._last
        self._last = center
        return Step(clamp(linear(center, last, self.steps), self.size))


@dataclass
class SecondOrderPredictor:
    """Second order, with inflections: what ``asm/trajectory_nonlinear.s`` does in each axis.

    An inflection, such as a bounce, is where the acceleration differs from the last by
    `threshold` or more: |a(k) - a(k-1)| >= threshold, for which four centres must be known. There
    the prediction is the centre itself and the calculation starts again from it (thesis 2.1.2:
    "the predicted position can be ignored and the calculation restarted after the hitting point").

    Attributes:
        size: rows or columns of the frame.
        threshold: change of the acceleration in pixels, at least 1; None: never an inflection.
        steps: frames ahead.
    """

    size: int
    threshold: int | None = None
    steps: int = 1
    _known: list[int] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        _check(self.size, self.steps)
        if self.threshold is not None and self.threshold < 1:
            raise ValueError(f"threshold: expected at least 1, found {self.threshold}")

    def update(self, center: int) -> Step:
        """Take the next valid centre."""
        known = self._known = [*self._known[-3:], center]
        if len(known) == 4 and self.threshold is not None:
            x3, x2, x1, x0 = known
            before, now = x1 - 2 * x2 + x3, x0 - 2 * x1 + x2
            if abs(now - before) >= self.threshold:
                self._known = [center]
                return Step(center, inflection=True)
        if len(known) < 3:
            return Step(clamp(linear(center, known[0], self.steps), self.size))
        x2, x1, x0 = known[-3:]
        return Step(clamp(second_order(x0, x1, x2, self.steps), self.size))


@dataclass
class RobustPredictor:
    """Second order over a two-frame baseline: what ``asm/trajectory_robust.s`` does in each axis.

    Until five centres are known it predicts as `LinearPredictor`.

    Attributes:
        size: rows or columns of the frame.
    """

    size: int
    _known: list[int] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        _check(self.size, 1)

    def update(self, center: int) -> Step:
        """Take the next valid centre."""
        known = self._known = [*self._known[-4:], center]
        if len(known) < 5:
            return Step(clamp(linear(center, known[-2:][0]), self.size))
        return Step(clamp(robust(known[4], known[2], known[0]), self.size))


class Predictor(Protocol):
    """Predicts both axes, centre by centre."""

    def update(self, row: int, col: int) -> tuple[Step, Step]:
        """Take the next valid centre; give what is expected of rows and of columns."""


@dataclass
class Both:
    """A predictor for each axis, independent of each other."""

    rows: AxisPredictor
    cols: AxisPredictor

    def update(self, row: int, col: int) -> tuple[Step, Step]:
        """Take the next valid centre."""
        return self.rows.update(row), self.cols.update(col)


@dataclass
class MixedPredictor:
    """One axis second order, the other linear, stopped while the object moves back.

    What ``asm/trajectory_mixed.s`` does, and what ran on silicon (thesis 2.1.4, figures 2.4 and
    2.5): "the algorithm stops calculations after the object begins moving in the negative X
    direction". A centre that lies `retreat` or more behind the last one is an inflection: it is
    repeated in both axes, and the calculation starts again from it (decision), so that it goes on
    as soon as the object moves forward.

    Attributes:
        size: (rows, columns) of the frame.
        axis: the second-order axis, 0 rows or 1 columns.
        direction: forward is 0: down or right, 1: up or left.
        retreat: least step back in pixels, at least 1.
    """

    size: tuple[int, int] = FRAME
    axis: int = 1
    direction: int = 0
    retreat: int = 1
    _last: int | None = field(default=None, init=False)
    _predictors: list[AxisPredictor] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        if self.axis not in {0, 1} or self.direction not in {0, 1} or self.retreat < 1:
            raise ValueError(f"expected axis and direction 0 or 1, retreat from 1: {self}")
        self._restart()

    def _restart(self) -> None:
        self._predictors = [LinearPredictor(self.size[0]), LinearPredictor(self.size[1])]
        self._predictors[self.axis] = SecondOrderPredictor(self.size[self.axis])

    def update(self, row: int, col: int) -> tuple[Step, Step]:
        """Take the next valid centre; only the step of `axis` may be an inflection."""
        here = (row, col)[self.axis]
        last = here if self._last is None else self._last
        self._last = here
        back = here - last if self.direction else last - here
        inflection = back >= self.retreat
        if inflection:
            self._restart()
        rows, cols = (p.update(x) for p, x in zip(self._predictors, (row, col), strict=True))
        if inflection and self.axis == 0:
            rows = Step(rows.predicted, inflection=True)
        elif inflection:
            cols = Step(cols.predicted, inflection=True)
        return rows, cols


def _check(size: int, steps: int) -> None:
    if not 1 <= size <= 256:
        raise ValueError(f"size: expected 1 to 256, found {size}")
    if not 1 <= steps <= MAX_STEPS:
        raise ValueError(f"steps: expected 1 to {MAX_STEPS}, found {steps}")


def linear_predictor(size: tuple[int, int] = FRAME, steps: int = 1) -> Both:
    """First order in both axes, as ``asm/trajectory.s``."""
    return Both(LinearPredictor(size[0], steps), LinearPredictor(size[1], steps))


def second_order_predictor(
    size: tuple[int, int] = FRAME, threshold: int | None = 3, steps: int = 1
) -> Both:
    """Second order in both axes, as ``asm/trajectory_nonlinear.s``."""
    return Both(
        SecondOrderPredictor(size[0], threshold, steps),
        SecondOrderPredictor(size[1], threshold, steps),
    )


def robust_predictor(size: tuple[int, int] = FRAME) -> Both:
    """Two-frame baseline in both axes, as ``asm/trajectory_robust.s``."""
    return Both(RobustPredictor(size[0]), RobustPredictor(size[1]))


def outputs(frames: Frames, predictor: Predictor, threshold: int = 32) -> dict[str, list[int]]:
    """What a trajectory program sends of a clip, one number per frame; 0 where nothing moves.

    Args:
        frames: uint8, shape (T, rows, columns).
        predictor: a fresh one, of the frame's size.
        threshold: least change of a pixel that moves.

    Returns:
        ``valid``, ``center_row``, ``center_col``, ``predicted_row``, ``predicted_col``, and
        ``inflection``: 1 in the rows + 2 in the columns. (``trajectory_mixed.s``, with one axis
        that can have any, sends 1 for either.)
    """
    names = ("valid", "center_row", "center_col", "predicted_row", "predicted_col", "inflection")
    sent: dict[str, list[int]] = {name: [] for name in names}
    for center in moving_centers(frames, threshold):
        values = (0, 0, 0, 0, 0, 0)
        if center is not None:
            rows, cols = predictor.update(*center)
            turn = rows.inflection + 2 * cols.inflection
            values = (1, *center, rows.predicted, cols.predicted, turn)
        for name, value in zip(names, values, strict=True):
            sent[name].append(value)
    return sent


def marked(frames: Frames, sent: Mapping[str, Sequence[int]]) -> Frames:
    """Frames with the predicted pixel drawn in: 255 where it was below 128, else 0.

    Args:
        frames: uint8, shape (T, rows, columns).
        sent: what `outputs` gives of them.

    Returns:
        uint8, shape (T, rows, columns): output ``picture`` of ``trajectory_nonlinear.s``.
    """
    picture = frames.copy()
    where = np.flatnonzero(sent["valid"])
    rows = np.asarray(sent["predicted_row"])[where]
    cols = np.asarray(sent["predicted_col"])[where]
    picture[where, rows, cols] = np.where(frames[where, rows, cols] < 128, 255, 0)
    return picture
