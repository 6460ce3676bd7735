"""Marks: what a position is worth, and the reasons why there is none."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from npchip.host.vision.fusion.camera import Floats, Rig

_PARALLEL = 1e-9
"""Rays count as parallel where 1 - t1·t2 is nearer to 0 than this: the point is then farther away
than 10⁹ times the distance of the cameras, or the numbers are not good enough to tell."""


class Status(IntEnum):
    """Mark of a position. `OK` and `BORDER` come with coordinates, the others with NaN."""

    OK = 0
    BORDER = 1
    """In the outermost row or column of a frame: an object there may be cut off."""
    UNSEEN = 2
    """One of the cameras, or both, does not see it (NaN in its place)."""
    OUTSIDE = 3
    """A pixel that is not in the frame."""
    PARALLEL = 4
    """The rays do not meet, or too far away to tell."""
    BEHIND = 5
    """The rays meet behind a camera."""
    OVERFLOW = 6
    """A word of the Q format is too short for the position or for what leads to it."""


class Crossing(NamedTuple):
    """Where rays meet in the plane: x, y (metres, NaN where not) and uint8 status."""

    x: Floats
    y: Floats
    status: NDArray[np.uint8]


def parallel(rig: Rig, h1: ArrayLike, h2: ArrayLike) -> NDArray[np.bool_]:
    """Whether rays with these offsets do not meet."""
    slope = np.asarray(h1) / rig.camera1.ratio * (np.asarray(h2) / rig.camera2.ratio)
    found: NDArray[np.bool_] = np.abs(1 - slope) <= _PARALLEL
    return found


def behind(rig: Rig, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
    """Whether points are not in front of both cameras."""
    one = rig.camera1.sign * (np.asarray(y) - rig.camera1.position[1]) <= 0
    two = rig.camera2.sign * (np.asarray(x) - rig.camera2.position[0]) <= 0
    found: NDArray[np.bool_] = one | two
    return found


def crossing(rig: Rig, h1: ArrayLike, h2: ArrayLike) -> Crossing:
    """Intersect rays in the x, y plane; h1 and h2 are broadcast against each other."""
    (x1, y1, _), (x2, y2, _) = rig.camera1.position, rig.camera2.position
    t1, t2 = np.asarray(h1) / rig.camera1.ratio, np.asarray(h2) / rig.camera2.ratio
    never = parallel(rig, h1, h2)
    along = (y2 - y1 + t2 * (x1 - x2)) / np.where(never, 1, 1 - t1 * t2)
    x, y = x1 + t1 * along, y1 + along
    status = np.where(never, Status.PARALLEL, np.where(behind(rig, x, y), Status.BEHIND, Status.OK))
    x, y = (np.where(status == Status.OK, value, np.nan) for value in (x, y))
    return Crossing(x, y, status.astype(np.uint8))
