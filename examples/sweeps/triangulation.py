"""Table 2.1 of the thesis: where two cameras locate an object, by every algorithm."""

from __future__ import annotations

from functools import lru_cache

from npchip.host.vision.fusion.experiment import SET, SETTINGS, Experiment


@lru_cache(maxsize=4)
def _drawn(setting: str, seed: int) -> Experiment:
    return Experiment.draw(SETTINGS[setting], SET, seed)


def error(setting: str, algorithm: str, seed: int) -> dict[str, float | None]:
    """Return the RMS distance from the truth in metres of a set of 100 paths.

    Args:
        setting: ``thesis`` or ``chip``.
        algorithm: a name of `npchip.host.vision.fusion.registry.ALGORITHMS`, or ``line``.
        seed: of the paths.
    """
    experiment = _drawn(setting, seed)
    row = experiment.line() if algorithm == "line" else experiment.row(algorithm)
    return {"rms": row.best, "rms_float": row.real, "rms_fixed": row.fixed, "marked": row.marked}
