"""Predictions along a path, judged: thesis 2.1.3, computed here or sent by the emulated chip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from npchip.host.vision.motion import MOTIONS, Path
from npchip.host.vision.prediction import (
    Predictor,
    linear_predictor,
    robust_predictor,
    second_order_predictor,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from npchip.host.vision.prediction import Centers

PREDICTORS: Final[dict[str, Callable[[], Predictor]]] = {
    "first order": linear_predictor,
    "second order": lambda: second_order_predictor(threshold=None),
    "second order, restarted": second_order_predictor,
    "two-frame baseline": robust_predictor,
}
"""The predictors of the error table by name."""

WARM_UP: Final = 4
"""Centres before the first prediction that is judged, the same for all predictors."""


@dataclass(frozen=True)
class Track:
    """Centres of a path and what was predicted from them, by a module or by a chip.

    Attributes:
        centers: int64, shape (N, 2): row and column of the valid centres.
        predicted: int64, shape (N, 2): expected place of the next centre.
        inflections: bool, shape (N, 2): where there was no prediction.
        impacts: bool, shape (N,): the object has hit the ground since the last centre.
    """

    centers: Centers
    predicted: Centers
    inflections: NDArray[np.bool_]
    impacts: NDArray[np.bool_]

    def errors(self) -> NDArray[np.float64]:
        """Predicted less actual next centre, from the fifth centre on; NaN at inflections.

        Returns:
            float64, shape (N - 5, 2), in pixels; shape (N - 5, 1), rows alone, where the object
            hits the ground: its columns move uniformly.
        """
        difference = (self.predicted[:-1] - self.centers[1:]).astype(np.float64)
        difference[self.inflections[:-1]] = np.nan
        return difference[WARM_UP:, : 1 if self.impacts.any() else 2]


def follow_outputs(path: Path, outputs_of_path: Mapping[str, NDArray[np.int32]]) -> Track:
    """Make a track of what a program has sent of a clip of a path.

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
    """Predict along the rounded centres of a path."""
    centers = path.rounded()
    steps = [predictor.update(row, col) for row, col in centers.tolist()]
    predicted = np.array([[step.predicted for step in both] for both in steps], np.int64)
    inflections = np.array([[step.inflection for step in both] for both in steps], bool)
    return Track(centers, predicted, inflections, path.impacts)


def rms(errors: Sequence[NDArray[np.float64]]) -> float:
    """Root of the mean square of all errors that are not NaN, in pixels along one axis."""
    every = np.concatenate([each.ravel() for each in errors])
    return float(np.sqrt(np.nanmean(every**2)))


def error_table(paths: int = 200, seed: int = 1) -> dict[str, dict[str, float]]:
    """RMS prediction error in pixels, along one axis, for each of `MOTIONS` and `PREDICTORS`.

    The error is that of a clamped prediction against the next *rounded* centre, from the fifth
    centre on; both axes together. Inflections, where nothing is predicted, do not count.

    Args:
        paths: random paths of each motion.
        seed: of the paths; every predictor sees the same.
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
    """How well inflections tell impacts, in the rows of bouncing paths.

    Attributes:
        found: share of the impacts with an inflection within `reach` frames.
        false_alarms: inflections without an impact in the frames before, per path.
        suppressed: share of the predictions that are withheld.
        rms: error where there is a prediction, next to no impact, in pixels.
    """

    found: float
    false_alarms: float
    suppressed: float
    rms: float


def inflection_score(tracks: Sequence[Track], reach: int = 2) -> InflectionScore:
    """Judge inflections. Impacts before the fifth centre cannot be found and do not count.

    Args:
        tracks: of bouncing paths.
        reach: frames that an impact changes accelerations after its own.
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
