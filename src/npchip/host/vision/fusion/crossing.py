"""Crossings of rays in the plane, for single pairs and as lookup tables, with marks."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from npchip.host.vision.fusion.camera import Floats, Rig

_PARALLEL = 1e-9
"""Rays count as parallel where 1 - t1·t2 is nearer to 0 than this: the point is then farther away
than 10⁹ times the distance of the cameras, or the numbers are not good enough to tell."""


class Status(IntEnum):
    """Mark of a position. `OK`, `BORDER` and `APART` come with coordinates, the others with NaN."""

    OK = 0
    BORDER = 1
    """A place in the outermost row or column of a frame: an object there may be cut off."""
    UNSEEN = 2
    """Not seen by one of the cameras, or both (NaN)."""
    OUTSIDE = 3
    """A pixel that is not in the frame."""
    PARALLEL = 4
    """The rays do not meet, or too far away to tell."""
    BEHIND = 5
    """The rays meet behind a camera."""
    OVERFLOW = 6
    """A word of the Q format is too short for the position or for what leads to it."""
    APART = 7
    """The rays miss each other by more than `apart` explains; only a run of two clips says so."""


def located(status: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Return whether marks are those of positions with coordinates."""
    return np.asarray((status <= Status.BORDER) | (status == Status.APART))


class Crossing(NamedTuple):
    """Crossings of rays in the plane: x and y (metres, NaN without one), and uint8 `Status`."""

    x: Floats
    y: Floats
    status: NDArray[np.uint8]


def parallel(rig: Rig, h1: ArrayLike, h2: ArrayLike) -> NDArray[np.bool_]:
    """Return whether rays with these offsets do not meet."""
    slope = np.asarray(h1) / rig.camera1.ratio * (np.asarray(h2) / rig.camera2.ratio)
    return np.abs(1 - slope) <= _PARALLEL


def behind(rig: Rig, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
    """Return whether points are not in front of both cameras."""
    one = rig.camera1.sign * (np.asarray(y) - rig.camera1.position[1]) <= 0
    two = rig.camera2.sign * (np.asarray(x) - rig.camera2.position[0]) <= 0
    return one | two


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


def apart(rig: Rig, one: ArrayLike, two: ArrayLike, slack: float = 0.5) -> NDArray[np.bool_]:
    """Return whether rays miss each other so far that errors of the pixels do not explain it.

    The columns of both cameras give a place on the floor, and each row a height there. Both heights
    are the same if some change of the four numbers by at most `slack` makes them so.

    Args:
        rig: the cameras.
        one: (..., 2), (row, column) in camera 1.
        two: the same for camera 2.
        slack: largest error of a row or column in pixels; that of the middle of a box is 1/2.

    Returns:
        bool, shape (...); False where rays do not meet in front of both cameras, or may not.
    """
    h1, v1 = rig.camera1.offsets(rig.camera1.straight(one))
    h2, v2 = rig.camera2.offsets(rig.camera2.straight(two))
    gaps = []
    for a, b, c, d in product((-slack, slack), repeat=4):
        x, y, _ = crossing(rig, h1 + a, h2 + b)
        (_, y1, z1), (x2, _, z2) = rig.camera1.position, rig.camera2.position
        up1 = z1 + (y - y1) * (v1 + c) / rig.camera1.ratio
        up2 = z2 + (x - x2) * (v2 + d) / rig.camera2.ratio
        gaps.append(up1 - up2)
    return np.asarray((np.min(gaps, axis=0) > 0) | (np.max(gaps, axis=0) < 0))


# ---- lookup tables (thesis 2.2.3)


@dataclass(frozen=True, eq=False)
class LookupTable:
    """Positions for pairs of cells: n1, n2 columns of camera 1 and 2, m rows of camera 1.

    Cells are numbered as in the frame, columns to the right and rows downwards, from 0. In the
    thesis x and y are "two two-input lookup tables" of n² entries. It leaves z open, which takes
    three inputs here (decision); only the plain table algorithm reads it.

    Attributes:
        x, y: float64, shape (n1, n2), metres.
        z: float64, shape (n1, n2, m), metres.
        status: uint8, shape (n1, n2): `Status` of the entry, 0 if it can be used.
    """

    x: Floats
    y: Floats
    z: Floats
    status: NDArray[np.uint8]


def middles(rig: Rig) -> tuple[Floats, Floats, Floats]:
    """Return the offsets h1, h2 and v1 of the middles of cells: shapes (n1,), (n2,), (m,)."""
    col1, col2, row = ((np.arange(n) + 0.5) * rig.cell - 0.5 for n in rig.cells)
    h1, _ = rig.camera1.offsets(np.stack([col1, col1], -1))
    h2, _ = rig.camera2.offsets(np.stack([col2, col2], -1))
    _, v1 = rig.camera1.offsets(np.stack([row, row], -1))
    return h1, h2, v1


def build_table(rig: Rig) -> LookupTable:
    """Compute the tables of a rig; mark entries whose rays do not meet in front of both cameras."""
    h1, h2, v1 = middles(rig)
    x, y, status = crossing(rig, h1[:, None], h2)
    z = rig.camera1.position[2] + (y - rig.camera1.position[1])[:, :, None] * v1 / rig.camera1.ratio
    return LookupTable(x, y, z, status)
