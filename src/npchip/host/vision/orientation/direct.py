"""Radial distance without a network: least squares with known angles (decision).

With polar and azimuth angle known, each vertex lies at F q / (r + d) in the picture, where q is its
place across the axis and d along it. With s = 1 / r that is F q s / (1 + d s), nearly linear in s,
and Gauss-Newton finds the s with the smallest distance from the three vertices found.

Key points lie inside the triangle, on the line that halves the angle of the true vertex, at nearly
the same distance for a vertex in all pictures. `bias` measures the three distances on pictures with
known poses, and `radial_distance` adds them to the vertices that it expects.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from npchip.host.vision.orientation.scene import (
    THESIS,
    TRIANGLE,
    Camera,
    Floats,
    in_camera,
    project,
)

_STEPS: Final = 8
_NEAREST: Final = 150.0
_FARTHEST: Final = 6_000.0


def bias(vertices: Floats, positions: Floats, camera: Camera = THESIS) -> Floats:
    """Find the mean distance of the found from the true vertices, inwards: shape (3,).

    Args:
        vertices: the vertices found, shape (N, 3, 2), in pixels.
        positions: true positions of the cameras, shape (N, 3), in mm.
        camera: frame and focal length of all cameras.
    """
    true = project(positions, camera=camera)
    return np.asarray(((vertices - true) * _halving(true)).sum(axis=2).mean(axis=0))


def _halving(triangles: Floats) -> Floats:
    """Return unit vectors from each vertex that halve its angle: shape (N, 3, 2)."""
    sides = [np.roll(triangles, turn, axis=1) - triangles for turn in (1, -1)]
    total = sum(side / np.linalg.norm(side, axis=2, keepdims=True) for side in sides)
    return np.asarray(total / np.linalg.norm(total, axis=2, keepdims=True))


def radial_distance(
    vertices: Floats, angles: Floats, inwards: Floats | None = None, camera: Camera = THESIS
) -> Floats:
    """Find the distances at which the vertices fit best.

    Args:
        vertices: the vertices found, shape (N, 3, 2), in pixels.
        angles: polar and azimuth angles, shape (N, 2), in radians.
        inwards: the result of `bias`; None for no bias.
        camera: frame and focal length of all cameras.

    Returns:
        shape (N,), in mm, from 150 to 6,000.
    """
    seen = in_camera(angles[:, 0], angles[:, 1], TRIANGLE)
    across, along = camera.focal * seen[:, :, :2], seen[:, :, 2:]
    nearness = np.full(len(vertices), 1 / 2_000)
    for _ in range(_STEPS):
        s = nearness[:, np.newaxis, np.newaxis]
        below = 1 + along * s
        expected = camera.middle + across * s / below
        if inwards is not None:
            expected = expected + _halving(expected) * inwards[:, np.newaxis]
        slope = across / below**2
        wrong = vertices - expected
        step = (wrong * slope).sum(axis=(1, 2)) / (slope * slope).sum(axis=(1, 2))
        nearness = np.clip(nearness + step, 1 / _FARTHEST, 1 / _NEAREST)
    return 1 / nearness


def multiplications() -> int:
    """Count multiplications, divisions and roots of `radial_distance` for a picture, with bias."""
    matrix = 2 * 3 * 3  # the third coordinate of the vertices is 0
    halving = 3 * (2 + 2 + 1 + 2)  # squares, quotients by the length of a side, then of the sum
    step = 3 * (1 + 2 + 2 + 2 + 2 + 2 + 2) + halving + 3 * 2 + 1
    return matrix + 6 + _STEPS * step + 1
