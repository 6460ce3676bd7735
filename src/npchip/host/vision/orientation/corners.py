"""Vertices of the triangle in a picture, the highlighted one first.

As ``asm/orientation.s`` does it: the corners are the farthest points of
`npchip.host.vision.keypoints`; the highlighted one is nearest, in rows plus columns, to the
brightest pixel (the last of several in the order of the scan); the others follow anticlockwise as
seen in the picture.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.host.vision.keypoints import farthest_points, object_mask
from npchip.host.vision.orientation.scene import Floats

THRESHOLD: Final = 44
"""Least level of an object pixel, which is at least 20 % covered, as in 3.3."""

Points = NDArray[np.int64]

_SLACK: Final = 1.6
"""Distance in pixels that counts as beyond the lines through the corners."""

_MOST: Final = 0.12
_LEAST: Final = 0.58
"""Parts of an object's pixels: the most beyond the lines, or missing, and the least inside them.
None of 6,000 random pictures of the triangle comes nearer than .09, .11 and .60; discs and
rectangles of 6 pixels or more have .2 and .55."""

_CONTRAST: Final = 8
"""Least difference in grey levels of a highlight from the rest of the object."""


def corner_pixels(picture: NDArray[np.uint8], threshold: int = THRESHOLD) -> Points | None:
    """Find the pixels of the three vertices, without a check that the picture shows a triangle.

    Args:
        picture: uint8, shape (rows, columns).
        threshold: least level of an object pixel.

    Returns:
        row and column of each, int64, shape (3, 2); None without an object.
    """
    found = farthest_points(object_mask(picture, threshold))
    if not found:
        return None
    points = np.array(found)
    (down, right), (next_down, next_right) = points[1:] - points[0]
    if down * next_right < right * next_down:
        points = points[[0, 2, 1]]
    from_end = int(np.argmax(picture.ravel()[::-1]))
    brightest = np.array(divmod(picture.size - 1 - from_end, picture.shape[1]))
    first = int(np.argmin(np.abs(points - brightest).sum(axis=1)))
    return np.roll(points, -first, axis=0)


def vertices(picture: NDArray[np.uint8], threshold: int = THRESHOLD, name: str = "it") -> Floats:
    """Find the vertices of the triangle with a highlighted vertex that a picture shows.

    Args:
        picture: uint8, shape (rows, columns).
        threshold: least level of an object pixel.
        name: name of the picture in messages.

    Returns:
        row and column of each, float64, shape (3, 2): whole numbers, which are middles of pixels.

    Raises:
        InputError: NP450, there is no object; NP451, it is not a triangle that lies entirely in the
            frame; NP452, it has no highlighted vertex.
    """
    points = corner_pixels(picture, threshold)
    if points is None:
        raise InputError(
            "NP450",
            f"{name}: shows nothing: no pixel is {threshold} or brighter, the brightest is"
            f" {picture.max()}",
            hint="give a brighter picture, or a lower --threshold",
        )
    mask = object_mask(picture, threshold)
    _check_triangle(mask, points, name)
    found = picture[mask]
    if int(found.max()) - np.median(found) < _CONTRAST:
        raise InputError(
            "NP452",
            f"{name}: no vertex is highlighted: the brightest pixel has {found.max()}, the whole"
            f" object {np.median(found):.0f}",
            hint=f"one corner has to be brighter than the rest, by {_CONTRAST} or more",
        )
    return points.astype(np.float64)


def _check_triangle(mask: NDArray[np.bool_], points: Points, name: str) -> None:
    rows, cols = np.nonzero(mask)
    if mask[[0, -1]].any() or mask[:, [0, -1]].any():
        raise InputError(
            "NP451",
            f"{name}: the object touches the border of the picture, so part of it may be missing",
            hint="the whole triangle has to be in the picture",
        )
    (down, right), (next_down, next_right) = points[1:] - points[0]
    if down * next_right == right * next_down:
        raise _no_triangle(name, f"its {len(rows)} pixels lie on a line", None)
    pixels = np.stack([rows, cols], axis=1)
    outside = np.zeros(len(pixels))
    for here, after in zip(points, np.roll(points, -1, axis=0), strict=True):
        along = after - here
        normal = np.array([along[1], -along[0]]) / np.hypot(*along)
        outside = np.maximum(outside, (pixels - here) @ normal)
    inside = _pixels_inside(mask.shape, points)
    count = len(rows)
    beyond, missing = int((outside > _SLACK).sum()), int((inside & ~mask).sum())
    hint = "is there another object, or noise above --threshold?"
    if beyond > _MOST * count or inside.sum() < _LEAST * count:
        which = f"{beyond} of its {count} pixels lie beyond the lines through its corners"
        raise _no_triangle(name, which, hint)
    if missing > _MOST * count:
        raise _no_triangle(name, f"{missing} pixels between its corners are dark", hint)


def _pixels_inside(shape: tuple[int, ...], points: Points) -> NDArray[np.bool_]:
    """Return whether the centres of pixels lie between those of the corners: bool, of `shape`."""
    rows, cols = np.ogrid[: shape[0], : shape[1]]
    inside = np.ones(shape, bool)
    for (row, col), (next_row, next_col) in zip(points, np.roll(points, -1, axis=0), strict=True):
        inside &= (rows - row) * (next_col - col) <= (cols - col) * (next_row - row)
    return inside


def _no_triangle(name: str, which: str, hint: str | None) -> InputError:
    return InputError("NP451", f"{name}: shows no triangle: {which}", hint=hint)
