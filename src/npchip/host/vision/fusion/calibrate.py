"""Angles of turned cameras, from a few points at known places (decision: not in the thesis).

A camera of a rig file stands straight. A real one is turned by a degree or two, which costs more
than the choice of the algorithm (``docs/rig.md``). The three angles follow from the pixels where
it sees known points, by least squares: Gauss-Newton with numeric derivatives. Two points are enough
in principle; more of them, spread over the frame, average the rounding to pixels.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from npchip.base.errors import InputError
from npchip.host.vision.fusion.camera import MOST_DEGREES, Camera, Rig

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from npchip.host.vision.fusion.camera import Floats

FEWEST: Final = 2
"""Fewest known points that a camera sees."""

_STEPS: Final = 20
_DEGREES: Final = 1e-4
"""Change of an angle for a derivative."""
_DIGITS: Final = 4
"""Digits of an angle: a thousandth of a pixel."""
_WEAK: Final = 1e-6
"""Ratio of singular values below which the points do not determine the angles."""


@dataclass(frozen=True)
class Calibration:
    """A rig whose cameras are turned as the points say.

    Attributes:
        rig: the cameras.
        points: how many points each camera sees.
        before: RMS distance of these points from where the given cameras would see them, pixels.
        after: the same for the cameras found.
    """

    rig: Rig
    points: tuple[int, int]
    before: tuple[float, float]
    after: tuple[float, float]


def calibrate(rig: Rig, points: ArrayLike, seen1: ArrayLike, seen2: ArrayLike) -> Calibration:
    """Find how the cameras of a rig are turned.

    Args:
        rig: the cameras, where they stand; the search begins as they are turned there.
        points: known places in metres, shape (n, 3).
        seen1: where camera 1 sees them, shape (n, 2), (row, column); NaN where it does not.
        seen2: the same for camera 2.

    Returns:
        the rig, and how well it explains the pixels.

    Raises:
        InputError: NP528, a camera sees fewer than `FEWEST` of the points, or they lie behind it or
            too close together; or it would be turned by more than `MOST_DEGREES`.
    """
    places = np.asarray(points, np.float64)
    cameras, counts, before, after = [], [], [], []
    for number, camera, seen in ((1, rig.camera1, seen1), (2, rig.camera2, seen2)):
        pixels = np.asarray(seen, np.float64)
        use = np.isfinite(pixels).all(axis=-1) & np.isfinite(places).all(axis=-1)
        if use.sum() < FEWEST:
            raise _cannot(number, f"it sees {use.sum()} of the points, and {FEWEST} are needed")
        found = _turned(number, camera, places[use], pixels[use])
        cameras.append(found)
        counts.append(int(use.sum()))
        before.append(_rms(_missed(camera, places[use], pixels[use])))
        after.append(_rms(_missed(found, places[use], pixels[use])))
    one, two = cameras
    return Calibration(
        replace(rig, camera1=one, camera2=two),
        (counts[0], counts[1]),
        (before[0], before[1]),
        (after[0], after[1]),
    )


def _turned(number: int, camera: Camera, places: Floats, pixels: Floats) -> Camera:
    for _ in range(_STEPS):
        missed = _missed(camera, places, pixels)
        if not np.isfinite(missed).all():
            raise _cannot(number, "some of the points lie behind it")
        slopes = []
        for axis in range(3):
            angles = list(camera.turned)
            # a step towards 0 stays within the limit
            step = -_DEGREES if angles[axis] > 0 else _DEGREES
            angles[axis] += step
            other = replace(camera, turned=(angles[0], angles[1], angles[2]))
            slopes.append((missed - _missed(other, places, pixels)) / step)
        jacobian = np.stack(slopes, -1)
        change, _, _, values = np.linalg.lstsq(jacobian, missed, rcond=None)
        if values[-1] < _WEAK * values[0]:
            raise _cannot(number, "the points lie too close together to tell how it is turned")
        pan, tilt, roll = np.asarray(camera.turned) + change
        if max(abs(pan), abs(tilt), abs(roll)) > MOST_DEGREES:
            raise _cannot(number, f"it would be turned by more than {MOST_DEGREES} degrees")
        camera = replace(camera, turned=(float(pan), float(tilt), float(roll)))
    pan, tilt, roll = (round(angle, _DIGITS) for angle in camera.turned)
    return replace(camera, turned=(pan, tilt, roll))


def _missed(camera: Camera, places: Floats, pixels: Floats) -> Floats:
    """Return by how many pixels points are seen elsewhere, rows and columns in turn."""
    return np.asarray((pixels - camera.project(places)[0]).ravel())


def _rms(missed: Floats) -> float:
    return float(np.sqrt(2 * np.mean(missed**2)))


def _cannot(number: int, why: str) -> InputError:
    return InputError(
        "NP528",
        f"camera{number} cannot be calibrated: {why}",
        hint="take points all over the frame of each camera; are rows, columns and places those of"
        " the same points?",
    )
