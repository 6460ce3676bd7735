"""Trajectory predictors on random paths, on the emulated chip and in a simulation: thesis 2.1.3.

On the chip a light disc moves along each path (`npchip.host.vision.motion`), a program follows it,
and its predictions are compared with what it finds in the next frame. The simulation predicts from
the true centres, rounded to pixels. docs/prediction.md has the figures.
"""

from __future__ import annotations

from functools import cache, lru_cache

import numpy as np

from npchip import Chip, assemble
from npchip.bundle import find
from npchip.host.vision.motion import MOTIONS, Path, discs
from npchip.host.vision.prediction import second_order_predictor
from npchip.host.vision.tracks import (
    PREDICTORS,
    Track,
    follow,
    follow_outputs,
    inflection_score,
)

PATHS = 100
NEVER = 255  # no motion here changes its acceleration by as much
LOW = 8  # a threshold at which the ideal sensor notices a disc that hardly moves

PROGRAMS = {
    "first order": ("trajectory", {"THRESHOLD": LOW}),
    "second order": ("trajectory_nonlinear", {"THRESHOLD": LOW, "INFLECTION": NEVER}),
    "second order, restarted": ("trajectory_nonlinear", {"THRESHOLD": LOW, "INFLECTION": 3}),
    "two-frame baseline": ("trajectory_robust", {"THRESHOLD": LOW}),
    "two-frame baseline, default": ("trajectory_robust", {}),
}
"""Programs and their constants; the last one only differs on the chip."""


@cache
def _paths(motion: str, seed: int) -> list[Path]:
    rng = np.random.default_rng(seed)
    return [MOTIONS[motion](rng) for _ in range(PATHS)]


@lru_cache(maxsize=8)
def _chip(program: str, defines: tuple[tuple[str, int], ...]) -> Chip:
    return Chip(assemble(find("program", program), defines=dict(defines)))


def _measured(program: str, defines: dict[str, int], motion: str, seed: int) -> list[Track]:
    chip = _chip(program, tuple(defines.items()))
    tracks = []
    for path in _paths(motion, seed):
        chip.reset()
        outputs = chip.run(discs(path)).outputs
        tracks.append(follow_outputs(path, {k: v for k, v in outputs.items() if k != "picture"}))
    return tracks


def error(where: str, motion: str, predictor: str, seed: int) -> dict[str, float]:
    """Return the RMS error of predictions in pixels along one axis, from the fifth centre on.

    Args:
        where: ``chip`` or ``simulation``.
        motion: a name of `MOTIONS`.
        predictor: a name of `PROGRAMS`.
        seed: of the paths.
    """
    if where == "chip":
        program, defines = PROGRAMS[predictor]
        tracks = _measured(program, defines, motion, seed)
    else:
        fresh = PREDICTORS[predictor.removesuffix(", default")]
        tracks = [follow(path, fresh()) for path in _paths(motion, seed)]
    errors = np.concatenate([track.errors().ravel() for track in tracks])
    errors = errors[~np.isnan(errors)]
    mean = float((errors**2).mean())
    return {"rms": mean**0.5, "mean_square": mean, "predictions": len(errors)}


def inflections(where: str, inflection: int, seed: int) -> dict[str, float]:
    """Return how inflections tell bounces, as `npchip.host.vision.tracks.InflectionScore`.

    Args:
        where: ``chip`` or ``simulation``.
        inflection: change of acceleration that is one; `NEVER` for none.
        seed: of the paths.
    """
    if where == "chip":
        settings = {"THRESHOLD": LOW, "INFLECTION": inflection}
        tracks = _measured("trajectory_nonlinear", settings, "bouncing", seed)
        return inflection_score(tracks, 3)._asdict()
    threshold = None if inflection == NEVER else inflection
    return inflection_score(
        [
            follow(path, second_order_predictor(threshold=threshold))
            for path in _paths("bouncing", seed)
        ]
    )._asdict()
