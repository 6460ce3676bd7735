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

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Frames = NDArray[np.uint8]
Centers = NDArray[np.int64]

MAX_STEPS: Final = 10
"""Most steps ahead for which no position leaves 16 bits, whatever the centres are."""

FRAME: Final = (64, 80)
"""Rows and columns of the thesis's frame."""


# ---- 2.1.1: position of the object


def moving_centers(frames: Frames, threshold: int = 32) -> list[tuple[int, int] | None]:
    """Find the centre of the bounding box of the pixels that change (thesis 2.1.1).

    The box spans the last and the present position of the object, so the centre lies between them.

    Args:
        frames: uint8, shape (T, rows, columns).
        threshold: least change of a pixel that moves.

    Returns:
        (row, column) for each frame, the means of first and last rounded down; None in the first
        frame and where nothing moves.
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


# ---- 2.1.2: prediction


def linear(x0: int, x1: int, steps: int = 1) -> int:
    """Continue a straight line from x(k) = x0 and x(k-1) = x1; not clamped to the frame."""
    return x0 + steps * (x0 - x1)


def second_order(x0: int, x1: int, x2: int, steps: int = 1) -> int:
    """Continue with constant acceleration, equations (2.1a-c), `steps` times; not clamped.

    Args:
        x0: the newest centre, x(k).
        x1: the centre x(k-1).
        x2: the centre x(k-2).
        steps: frames ahead.
    """
    v = x1 - x2  # (2.1a)
    a = x0 - x1 - v  # (2.1b)
    for _ in range(steps):
        x0, v = x0 + v + 2 * a, v + a  # (2.1c); v becomes the older displacement of the next step
    return x0


def robust(x0: int, x2: int, x4: int) -> int:
    """Continue the parabola through every second centre, rounded half up; not clamped.

    It is as exact as (2.1c) for constant acceleration, but amplifies rounding errors of the centres
    by sqrt(334)/8 = 2.3 rather than sqrt(19) = 4.4 (decision; see docs/prediction.md).

    Args:
        x0: the newest centre, x(k).
        x2: the centre x(k-2).
        x4: the centre x(k-4).
    """
    return (15 * x0 - 10 * x2 + 3 * x4 + 4) >> 3


def clamp(value: int, size: int) -> int:
    """Return the position in a frame of `size` rows or columns that is nearest to `value`."""
    return min(max(value, 0), size - 1)


class Prediction(NamedTuple):
    """The prediction for one axis after a centre.

    Attributes:
        predicted: the expected centre, within the frame.
        inflection: whether the motion has changed here, so that `predicted` repeats the centre.
    """

    predicted: int
    inflection: bool = False


class AxisPredictor(Protocol):
    """Predictor of one axis, centre by centre."""

    def update(self, center: int) -> Prediction:
        """Take the next valid centre and return the prediction."""


@dataclass
class LinearPredictor:
    """First-order predictor of one axis, as in ``asm/trajectory.s``.

    Attributes:
        size: rows or columns of the frame.
        steps: frames ahead.
    """

    size: int
    steps: int = 1
    _last: int | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        _check(self.size, self.steps)

    def update(self, center: int) -> Prediction:
        """Take the next valid centre and return the prediction."""
        last = center if self._last is None else self._last
        self._last = center
        return Prediction(clamp(linear(center, last, self.steps), self.size))


@dataclass
class SecondOrderPredictor:
    """Second-order predictor of one axis with inflections, as in ``asm/trajectory_nonlinear.s``.

    An inflection, such as a bounce, is a change of the acceleration by `threshold` or more:
    |a(k) - a(k-1)| >= threshold, which takes four centres. The prediction then is the centre
    itself, and the calculation restarts from it (thesis 2.1.2: "the predicted position can be
    ignored and the calculation restarted after the hitting point").

    Attributes:
        size: rows or columns of the frame.
        threshold: change of the acceleration in pixels, at least 1; None for no inflections.
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

    def update(self, center: int) -> Prediction:
        """Take the next valid centre and return the prediction."""
        known = self._known = [*self._known[-3:], center]
        if len(known) == 4 and self.threshold is not None:
            x3, x2, x1, x0 = known
            before, now = x1 - 2 * x2 + x3, x0 - 2 * x1 + x2
            if abs(now - before) >= self.threshold:
                self._known = [center]
                return Prediction(center, inflection=True)
        if len(known) < 3:
            return Prediction(clamp(linear(center, known[0], self.steps), self.size))
        x2, x1, x0 = known[-3:]
        return Prediction(clamp(second_order(x0, x1, x2, self.steps), self.size))


@dataclass
class RobustPredictor:
    """Second-order predictor of one axis over two frames, as in ``asm/trajectory_robust.s``.

    It predicts as `LinearPredictor` until it knows five centres.

    Attributes:
        size: rows or columns of the frame.
    """

    size: int
    _known: list[int] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        _check(self.size, 1)

    def update(self, center: int) -> Prediction:
        """Take the next valid centre and return the prediction."""
        known = self._known = [*self._known[-4:], center]
        if len(known) < 5:
            return Prediction(clamp(linear(center, known[-2:][0]), self.size))
        return Prediction(clamp(robust(known[4], known[2], known[0]), self.size))


class Predictor(Protocol):
    """Predictor of both axes, centre by centre."""

    def update(self, row: int, col: int) -> tuple[Prediction, Prediction]:
        """Take the next valid centre and return the predictions for rows and columns."""


class Both(NamedTuple):
    """Independent predictors of the two axes."""

    rows: AxisPredictor
    cols: AxisPredictor

    def update(self, row: int, col: int) -> tuple[Prediction, Prediction]:
        """Take the next valid centre and return the predictions for rows and columns."""
        return self.rows.update(row), self.cols.update(col)


@dataclass
class MixedPredictor:
    """Predictor of the second order in one axis and the first in the other, with stops.

    It computes as ``asm/trajectory_mixed.s``, which ran on silicon (thesis 2.1.4, figures 2.4 and
    2.5): "the algorithm stops calculations after the object begins moving in the negative X
    direction". A centre `retreat` pixels or more behind the last one is an inflection: the
    prediction repeats it in both axes, and the calculation restarts from it (decision).

    Attributes:
        size: (rows, columns) of the frame.
        axis: the second-order axis: 0 for rows, 1 for columns.
        direction: the forward direction: 0 for down or right, 1 for up or left.
        retreat: smallest step back in pixels that is an inflection, at least 1.
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

    def update(self, row: int, col: int) -> tuple[Prediction, Prediction]:
        """Take the next valid centre; only the prediction of `axis` may be an inflection."""
        here = (row, col)[self.axis]
        last = here if self._last is None else self._last
        self._last = here
        back = here - last if self.direction else last - here
        inflection = back >= self.retreat
        if inflection:
            self._restart()
        found = [p.update(x) for p, x in zip(self._predictors, (row, col), strict=True)]
        found[self.axis] = found[self.axis]._replace(inflection=inflection)
        return found[0], found[1]


def _check(size: int, steps: int) -> None:
    if not 1 <= size <= 256:
        raise ValueError(f"size: expected 1 to 256, found {size}")
    if not 1 <= steps <= MAX_STEPS:
        raise ValueError(f"steps: expected 1 to {MAX_STEPS}, found {steps}")


def linear_predictor(size: tuple[int, int] = FRAME, steps: int = 1) -> Both:
    """Make the predictor of ``asm/trajectory.s``: first order in both axes."""
    return Both(*(LinearPredictor(each, steps) for each in size))


def second_order_predictor(
    size: tuple[int, int] = FRAME, threshold: int | None = 3, steps: int = 1
) -> Both:
    """Make the predictor of ``asm/trajectory_nonlinear.s``: second order in both axes."""
    return Both(*(SecondOrderPredictor(each, threshold, steps) for each in size))


def robust_predictor(size: tuple[int, int] = FRAME) -> Both:
    """Make the predictor of ``asm/trajectory_robust.s``: two-frame baseline in both axes."""
    return Both(*map(RobustPredictor, size))


def outputs(frames: Frames, predictor: Predictor, threshold: int = 32) -> dict[str, list[int]]:
    """Compute the outputs of a trajectory program for a clip.

    Args:
        frames: uint8, shape (T, rows, columns).
        predictor: a new predictor for the size of the frames.
        threshold: least change of a pixel that moves.

    Returns:
        ``valid``, ``center_row``, ``center_col``, ``predicted_row``, ``predicted_col``, and
        ``inflection``: 1 in the rows + 2 in the columns; one number per frame, 0 where nothing
        moves. (``trajectory_mixed.s`` sends 1 for an inflection in either axis.)
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
    """Draw the predicted pixel into every frame: 255 where it was below 128, else 0.

    Args:
        frames: uint8, shape (T, rows, columns).
        sent: the result of `outputs` for them.

    Returns:
        uint8, shape (T, rows, columns): output ``picture`` of ``trajectory_nonlinear.s``.
    """
    picture = frames.copy()
    where = np.flatnonzero(sent["valid"])
    rows = np.asarray(sent["predicted_row"])[where]
    cols = np.asarray(sent["predicted_col"])[where]
    picture[where, rows, cols] = np.where(frames[where, rows, cols] < 128, 255, 0)
    return picture
