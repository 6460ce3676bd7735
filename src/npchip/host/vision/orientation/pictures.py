"""Pictures of the triangle: thousands at a time, with the coverage of every pixel.

*Thesis*: a vertex is highlighted (figure 3.14), to distinguish the key points. *Decision*: the grey
levels, and as highlight the corner up to 22 % of the legs. It is small enough that its pixels are
nearest to their own vertex, and large enough that one of them is the brightest of the picture, even
if the triangle is only a few pixels high: none of 16,000 random poses yields a wrong vertex (with
18 % two do).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.orientation.scene import THESIS, TRIANGLE, Camera, Floats, project

Pictures = NDArray[np.uint8]

BACKGROUND: Final = 20
OBJECT: Final = 140
HIGHLIGHT: Final = 240
CORNER: Final = 0.22
"""Part of the legs that is highlighted."""

_LINES: Final = 16
"""Lines on which a row of pixels is measured; along each line coverage is exact."""

_BATCH: Final = 250


def render(positions: Floats, camera: Camera = THESIS, *, highlight: bool = True) -> Pictures:
    """Draw the views of cameras.

    Args:
        positions: positions of the cameras, shape (N, 3), in mm.
        camera: frame and focal length of all cameras.
        highlight: whether one vertex is brighter, unlike in the thesis's first pictures.

    Returns:
        uint8, shape (N, rows, columns).

    Raises:
        ValueError: a vertex is not in front of a camera.
    """
    corner = TRIANGLE[0] + CORNER * (TRIANGLE - TRIANGLE[0])
    pictures = np.empty((len(positions), camera.rows, camera.cols), np.uint8)
    for first in range(0, len(positions), _BATCH):
        some = positions[first : first + _BATCH]
        shape, light = (
            coverage(project(some, points, camera), camera.rows, camera.cols)
            for points in (TRIANGLE, corner)
        )
        level = BACKGROUND + (OBJECT - BACKGROUND) * shape
        if highlight:
            level += (HIGHLIGHT - OBJECT) * light
        pictures[first : first + _BATCH] = np.floor(level + 0.5)
    return pictures


def coverage(polygons: Floats, rows: int, cols: int) -> NDArray[np.float32]:
    """Find the part of every pixel that convex polygons cover.

    On every line each side adds the part to its right, with the sign of its direction: one number
    for the pixel that it crosses and one for the next, which a running sum completes.

    Args:
        polygons: row and column of corners in order, shape (N, n, 2); whole numbers are middles of
            pixels.
        rows: rows of the frame.
        cols: columns of the frame.

    Returns:
        float32 from 0 to 1, shape (N, rows, columns).

    Raises:
        ValueError: a corner is not finite.
    """
    if not np.isfinite(polygons).all():
        raise ValueError("corners that are not finite: is the triangle behind the camera?")
    polygons = polygons + 0.5  # whole numbers between pixels from here on
    lines = (np.arange(rows * _LINES) + 0.5) / _LINES
    width = cols + 2
    size = len(polygons) * rows * width
    change = np.zeros(size)
    for a, b in zip(
        np.moveaxis(polygons, 1, 0), np.moveaxis(np.roll(polygons, -1, 1), 1, 0), strict=True
    ):
        crosses = (a[:, :1] > lines) != (b[:, :1] > lines)
        number, line = np.nonzero(crosses)
        (row, col), (next_row, next_col) = a[number].T, b[number].T
        at = col + (lines[line] - row) * (next_col - col) / (next_row - row)
        at = np.clip(at, 0, cols)
        pixel = np.floor(at).astype(np.int64)
        part = at - pixel
        sign = np.where(row > next_row, 1.0, -1.0)
        place = (number * rows + line // _LINES) * width + pixel
        change += np.bincount(place, sign * (1 - part), size)
        change += np.bincount(place + 1, sign * part, size)
    covered = np.cumsum(change.reshape(len(polygons), rows, width), axis=2)[:, :, :cols]
    return np.clip(np.abs(covered) / _LINES, 0, 1).astype(np.float32)
