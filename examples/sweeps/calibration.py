"""Errors of a turned camera, with and without calibration from known points."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from npchip.host.vision.fusion import calibrate, locate
from npchip.host.vision.fusion.experiment import SETTINGS, rms, straight_paths

if TYPE_CHECKING:
    from npchip.host.vision.fusion.camera import Floats

PATHS = 100
AXES = ("pan", "tilt", "roll")


def turned_camera(
    algorithm: str, turned: str, degrees: float, points: int, seed: int
) -> dict[str, float]:
    """Return the RMS error in metres of random paths on the chip's rig, camera 2 turned.

    Args:
        algorithm: a name of `npchip.host.vision.fusion.registry.ALGORITHMS`.
        turned: ``pan``, ``tilt`` or ``roll``.
        degrees: by how much.
        points: known points from which both cameras are calibrated; 0 for none.
        seed: of paths and points.

    Returns:
        ``rms``, and ``angle``: how far the angles found are from the true ones, RMS in degrees.
    """
    rig = SETTINGS["chip"].rig
    angles = [0.0, 0.0, 0.0]
    angles[AXES.index(turned)] = degrees
    true = (angles[0], angles[1], angles[2])
    real = replace(rig, camera2=replace(rig.camera2, turned=true))
    rng = np.random.default_rng(seed)
    paths = straight_paths(rig, PATHS, rng)
    known = straight_paths(rig, max(points, 1), rng)[:points, 0]
    used = rig
    if points:
        used = calibrate(rig, known, real.camera1.observe(known), real.camera2.observe(known)).rig
    seen = real.camera1.observe(paths), real.camera2.observe(paths)
    found: Floats = locate(used, *seen, algorithm).points
    missed = np.array([used.camera1.turned, np.subtract(used.camera2.turned, true)])
    return {"rms": rms(found, paths), "angle": float(np.sqrt((missed**2).mean()))}
