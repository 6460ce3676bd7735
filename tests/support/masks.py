"""Masks of objects for the programs that find corners, and frames that show them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from npchip.host.vision.polygons import (
    Mask,
    random_polygon,
    random_triangle,
    random_triangles,
    raster,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]


def scene(seed: int) -> Mask:
    """One or several triangles, a polygon, a noisy triangle, or noise alone."""
    rng = np.random.default_rng(seed)
    match seed % 6:
        case 0:
            return raster(random_triangle(rng, "acute"))
        case 1:
            return raster(random_triangle(rng, "obtuse"))
        case 2:
            return random_triangles(rng, int(rng.integers(2, 4)))[1]
        case 3:
            corners = int(rng.integers(3, 10))
            return raster(random_polygon(rng, corners))
        case 4:
            triangle = raster(random_triangle(rng, "acute"))
            noisy: Mask = triangle ^ (rng.random((64, 80)) < rng.choice([0.001, 0.01]))
            return noisy
        case _:
            noise: Mask = rng.random((64, 80)) < rng.choice([0.001, 0.02, 0.3, 0.5, 0.9])
            return noise


def drawn(masks: list[Mask]) -> Frames:
    """Return a frame for each mask, whose objects a threshold of 128 finds just about."""
    return np.where(np.array(masks), 128, 127).astype(np.uint8)


def rectangles() -> list[Mask]:
    """Return rectangles in corners, at borders and over all of the frame, and their opposites."""
    masks: list[Mask] = []
    for rows in ((0, 1), (0, 9), (60, 64), (7, 9), (0, 64)):
        for cols in ((0, 1), (0, 9), (70, 80), (7, 9), (0, 80)):
            mask = np.zeros((64, 80), bool)
            mask[slice(*rows), slice(*cols)] = True
            masks += [mask, ~mask]
    return masks
