"""Errors of predictions along a path (thesis 2.1.3), computed here or sent by the emulated chip."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.motion import MOTIONS, Path
from npchip.host.vision.prediction import (
    Centers,
    Predictor,
    linear_predictor,
    robust_predictor,
    second_order_predictor,
)

PREDICTORS: Final[dict[str, Callable[[], Predictor]]] = {
    "first order": linear_predictor,
    "second order": lambda: second_order_predictor(threshold=None),
    "second order, restarted": second_order_predictor,
    "two-frame baseline": robust_predictor,
}
"""Predictors of the error table by name."""

WARM_UP: Final = 4
"""Centres before the first prediction that counts, the same for all predictors."""


@dataclass(frozen=True)
class Track:
    """Centres of a path and the predictions made from them.

    Attributes:
        centers: int64, shape (N, 2): row and column of the valid centres.
        predicted: int64, shape (N, 2): predicted next centre.
        inflections: bool, shape (N, 2): whether there was no prediction.
        impacts: bool, shape (N,): whether the object has hit the ground since the last centre.
    """

    centers: Centers
    predicted: Centers
    inflections: NDArray[np.bool_]
    impacts: NDArray[np.bool_]

    def errors(self) -> NDArray[np.float64]:
        """Subtract the actual from the predicted next centre, from the fifth centre on.

        Returns:
            float64, shape (N - 5, 2), in pixels, NaN at inflections; shape (N - 5, 1), rows only,
            if the object hits the ground, since it then moves uniformly along the columns.
        """
        difference = (self.predicted[:-1] - self.centers[1:]).astype(np.float64)
        difference[self.inflections[:-1]] = np.nan
        return difference[WARM_UP:, : 1 if self.impacts.any() else 2]


def follow_outputs(path: Path, outputs_of_path: Mapping[str, NDArray[np.int32]]) -> Track:
    """Make a track from the outputs of a program for a clip of a path.

    Args:
        path: the true motion.
        outputs_of_path: outputs of ``asm/trajectory*.s`` by name, int, shape (T,).
    """
    sent = {name: np.asarray(values, np.int64) for name, values in outputs_of_path.items()}
    valid = np.flatnonzero(sent["valid"])
    turn = sent.get("inflection", np.zeros(len(path.centers), np.int64))[valid]
    impacts = np.diff(np.cumsum(path.impacts)[valid], prepend=0) > 0
    centers, predicted = (
        np.stack([sent[f"{kind}_row"][valid], sent[f"{kind}_col"][valid]], axis=1)
        for kind in ("center", "predicted")
    )
    return Track(centers, predicted, np.stack([turn & 1, turn >> 1], axis=1) > 0, impacts)


def follow(path: Path, predictor: Predictor) -> Track:
    """Make a track by predicting from the rounded centres of a path."""
    centers = path.rounded()
    steps = [predictor.update(row, col) for row, col in centers.tolist()]
    predicted = np.array([[step.predicted for step in both] for both in steps], np.int64)
    inflections = np.array([[step.inflection for step in both] for both in steps], bool)
    return Track(centers, predicted, inflections, path.impacts)


def rms(errors: Sequence[NDArray[np.float64]]) -> float:
    """Return the RMS of all errors that are not NaN, in pixels along one axis."""
    every = np.concatenate([each.ravel() for each in errors])
    return float(np.sqrt(np.nanmean(every**2)))


def error_table(paths: int = 200, seed: int = 1) -> dict[str, dict[str, float]]:
    """Measure the RMS prediction error in pixels along one axis for `MOTIONS` and `PREDICTORS`.

    The error compares a clamped prediction with the next *rounded* centre, from the fifth centre
    on, over both axes. Inflections, where nothing is predicted, do not count.

    Args:
        paths: number of random paths of each motion.
        seed: seed of the paths, which are the same for every predictor.
    """
    table: dict[str, dict[str, float]] = {}
    for name, make in MOTIONS.items():
        rng = np.random.default_rng(seed)
        drawn = [make(rng) for _ in range(paths)]
        table[name] = {
            kind: rms([follow(path, fresh()).errors() for path in drawn])
            for kind, fresh in PREDICTORS.items()
        }
    return table


class InflectionScore(NamedTuple):
    """Agreement of inflections with impacts, in the rows of bouncing paths.

    Attributes:
        found: share of the impacts with an inflection within `reach` frames.
        false_alarms: inflections per path without an impact in the frames before.
        suppressed: share of the predictions that are withheld.
        rms: RMS error in pixels where there is a prediction and no impact follows.
    """

    found: float
    false_alarms: float
    suppressed: float
    rms: float


def inflection_score(tracks: Sequence[Track], reach: int = 2) -> InflectionScore:
    """Compare inflections with impacts. Impacts before the fifth centre do not count.

    Args:
        tracks: tracks of bouncing paths.
        reach: number of frames after its own in which an impact changes the acceleration.
    """
    impacts = found = alarms = withheld = predictions = 0
    errors = []
    for track in tracks:
        flags = track.inflections[:, 0]
        for k in np.flatnonzero(track.impacts[WARM_UP:]) + WARM_UP:
            if k + reach < len(flags):
                impacts += 1
                found += bool(flags[k : k + reach + 1].any())
        for k in np.flatnonzero(flags):
            alarms += not track.impacts[max(k - reach, 0) : k + 1].any()
        withheld += int(flags[WARM_UP:-1].sum())
        predictions += len(flags[WARM_UP:-1])
        judged = track.errors()[:, 0]
        errors.append(np.where(track.impacts[WARM_UP + 1 :], np.nan, judged))
    return InflectionScore(
        found / max(impacts, 1), alarms / len(tracks), withheld / max(predictions, 1), rms(errors)
    )
