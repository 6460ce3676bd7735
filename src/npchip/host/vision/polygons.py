"""Random shapes and their pixels, as the simulation of thesis 3.3.4 draws them.

Vertices are (row, column), and whole numbers are the middles of pixels: pixel (r, c) covers r - 1/2
to r + 1/2 and c - 1/2 to c + 1/2. The thesis does not describe its rasterization: here a pixel
belongs to a shape that covers at least a given part of it, 20 % by default (decision: the tips of
sharp corners then mostly stay connected), as counted on `SAMPLES` x `SAMPLES` points of the pixel.
"""

from __future__ import annotations

from math import ceil, pi
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
Vertices = NDArray[np.float64]
Kind = Literal["acute", "obtuse"]

SAMPLES: Final = 10
FRAME: Final = (64, 80)
SMALLEST_ANGLE: Final = 20.0
COVERAGE: Final = 0.2
SHORTEST_SIDE: Final = 12.0
BEND: Final = 15.0


def raster(vertices: Vertices, frame: tuple[int, int] = FRAME, coverage: float = COVERAGE) -> Mask:
    """Draw a polygon as the pixels of which it covers the given part or more.

    Args:
        vertices: shape (n, 2), in order; overlaps follow the even-odd rule.
        frame: rows and columns.
        coverage: the part of a pixel, above 0, up to 1.

    Returns:
        bool, shape `frame`.
    """
    needed = ceil(coverage * SAMPLES * SAMPLES - 1e-9)
    return np.asarray(covered(vertices, frame) >= needed)


def covered(vertices: Vertices, frame: tuple[int, int] = FRAME) -> NDArray[np.uint8]:
    """Return how much of each pixel a polygon covers.

    Args:
        vertices: shape (n, 2), in order; overlaps follow the even-odd rule.
        frame: rows and columns.

    Returns:
        uint8, shape `frame`: how many of its `SAMPLES` x `SAMPLES` points.
    """
    counts = np.zeros(frame, np.uint8)
    vertices = vertices + 0.5  # whole numbers between pixels from here on
    low = np.maximum(np.floor(vertices.min(axis=0)), 0).astype(int)
    high = np.minimum(np.ceil(vertices.max(axis=0)), frame).astype(int)
    if (low >= high).any():
        return counts
    rows = _samples(low[0], high[0])[:, np.newaxis]
    cols = _samples(low[1], high[1])
    inside = np.zeros((len(rows), len(cols)), bool)
    for (row, col), (next_row, next_col) in zip(
        vertices, np.roll(vertices, -1, axis=0), strict=True
    ):
        if row != next_row:
            beside = (row <= rows) != (next_row <= rows)
            crossing = col + (rows - row) * (next_col - col) / (next_row - row)
            inside ^= beside & (cols < crossing)
    height, width = high - low
    points = inside.reshape(height, SAMPLES, width, SAMPLES).sum(axis=(1, 3))
    counts[low[0] : high[0], low[1] : high[1]] = points
    return counts


def _samples(first: int, end: int) -> NDArray[np.float64]:
    return (np.arange(first * SAMPLES, end * SAMPLES) + 0.5) / SAMPLES


def random_triangle(
    rng: np.random.Generator,
    kind: Kind,
    longest: tuple[float, float] = (15, 60),
    frame: tuple[int, int] = FRAME,
) -> Vertices:
    """Draw a triangle of any shape, size, orientation and place.

    Args:
        rng: source of the random numbers.
        kind: ``"acute"`` for a largest angle below 90 degrees, ``"obtuse"`` for one above.
        longest: range of the longest side.
        frame: rows and columns; the triangle keeps a distance of 1 from its border.

    Returns:
        shape (3, 2). No angle is below `SMALLEST_ANGLE` degrees.
    """
    while True:
        angles = SMALLEST_ANGLE + rng.dirichlet((1, 1, 1)) * (180 - 3 * SMALLEST_ANGLE)
        if (angles.max() < 90) != (kind == "acute"):
            continue
        sides = np.sin(np.radians(angles))
        sides *= rng.uniform(*longest) / sides.max()
        angle = np.radians(angles[0])
        third = sides[1] * np.array([np.sin(angle), np.cos(angle)])
        placed = _placed(rng, np.array([[0, 0], [0, sides[2]], third]), frame)
        if placed is not None:
            return placed


def random_polygon(
    rng: np.random.Generator,
    corners: int,
    radius: tuple[float, float] = (6, 30),
    frame: tuple[int, int] = FRAME,
) -> Vertices:
    """Draw a polygon, mostly not convex, around its centre.

    Args:
        rng: source of the random numbers.
        corners: number of corners, at least 3.
        radius: range of the distances of the corners from the centre.
        frame: rows and columns; the polygon keeps a distance of 1 from its border.

    Returns:
        shape (corners, 2).
    """
    while True:
        angles = np.sort(rng.uniform(0, 2 * pi, corners))
        around = rng.uniform(*radius, corners)[:, np.newaxis] * _directions(angles)
        placed = _placed(rng, around, frame)
        if placed is not None:
            return placed


def random_convex_polygon(rng: np.random.Generator, corners: int) -> Vertices:
    """Draw a convex polygon whose corners a tracer can tell: sides of 12 pixels or more.

    Args:
        rng: source of the random numbers.
        corners: number of corners, 3 to 8.

    Returns:
        shape (corners, 2); the largest distance of two corners is 40 to 60 pixels, and no angle is
        below `SMALLEST_ANGLE` or above 180 - `SMALLEST_ANGLE` degrees.
    """
    while True:
        angles = np.sort(rng.uniform(0, 2 * pi, corners))
        points = _directions(angles) * rng.uniform(0.5, 1, (1, 2))
        across = np.linalg.norm(points[:, np.newaxis] - points, axis=2)
        points *= rng.uniform(40, 60) / across.max()
        if not (_sides(points) >= SHORTEST_SIDE).all() or not _is_clear(points):
            continue
        placed = _placed(rng, points, FRAME)
        if placed is not None:
            return placed


def random_regular_polygon(
    rng: np.random.Generator, corners: int, radius: tuple[float, float] = (10, 30)
) -> Vertices:
    """Draw a regular polygon anywhere in the frame.

    Args:
        rng: source of the random numbers.
        corners: number of corners, at least 3.
        radius: range of the distance of the corners from the centre.

    Returns:
        shape (corners, 2).
    """
    while True:
        around = _directions(2 * pi * np.arange(corners) / corners) * rng.uniform(*radius)
        placed = _placed(rng, around, FRAME)
        if placed is not None:
            return placed


def hinged(rng: np.random.Generator, vertices: Vertices) -> Vertices | None:
    """Bend a convex polygon at its corners: other angles, the same sides in the same order.

    Side lengths cannot tell the result from the polygon itself (thesis 3.3.3).

    Args:
        rng: source of the random numbers.
        vertices: shape (n, 2) with n of at least 4, convex.

    Returns:
        shape (n, 2), convex, anywhere, clockwise as seen on the screen, with an angle that has
        changed by `BEND` degrees or more; None if 1,000 attempts find none, as some shapes hardly
        bend.
    """
    sides, turns = _sides(vertices), abs(_turns(vertices))
    fan = np.linalg.norm(vertices - vertices[0], axis=1)  # diagonals from corner 0
    for _ in range(1000):
        wanted = fan.copy()
        wanted[2:-1] *= rng.uniform(0.6, 1.4, len(fan) - 3)
        # Triangles between two neighbouring diagonals and a side: their angles at corner 0.
        a, b, c = wanted[1:-1], wanted[2:], sides[1:-1]
        cosines = (a * a + b * b - c * c) / (2 * a * b)
        if (abs(cosines) >= 1).any():
            continue
        angles = np.concatenate([[0, 0], np.cumsum(np.arccos(cosines))])
        bent: Vertices = wanted[:, np.newaxis] * _directions(angles)
        if _is_clear(bent) and (abs(_turns(bent) - turns) >= BEND).any():
            return bent
    return None


def _directions(angles: NDArray[np.float64]) -> Vertices:
    return np.stack([np.sin(angles), np.cos(angles)], axis=1)


def _sides(vertices: Vertices) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(np.roll(vertices, -1, axis=0) - vertices, axis=1))


def _is_clear(vertices: Vertices) -> bool:
    """Return whether a polygon turns once round, with no corner too sharp or too blunt."""
    turns = _turns(vertices)
    least, most = SMALLEST_ANGLE, 180 - SMALLEST_ANGLE
    return bool(((turns >= least) & (turns <= most)).all() and round(float(turns.sum())) == 360)


def _turns(vertices: Vertices) -> NDArray[np.float64]:
    """Return the change of direction in degrees at corners 1, 2 ... 0, with its sign."""
    ahead = np.roll(vertices, -1, axis=0) - vertices
    after = np.roll(ahead, -1, axis=0)
    cross = ahead[:, 1] * after[:, 0] - ahead[:, 0] * after[:, 1]
    return np.asarray(np.degrees(np.arctan2(cross, (ahead * after).sum(axis=1))))


def random_triangles(
    rng: np.random.Generator,
    count: int,
    longest: tuple[float, float] = (15, 35),
    frame: tuple[int, int] = FRAME,
) -> tuple[list[Vertices], Mask]:
    """Draw triangles with at least a pixel of background between them.

    Returns:
        the vertices of each, and the mask of all.
    """
    shapes: list[Vertices] = []
    drawn = np.zeros(frame, bool)
    for _ in range(count):
        while True:
            kind: Kind = "acute" if rng.random() < 0.5 else "obtuse"
            vertices = random_triangle(rng, kind, longest, frame)
            mask = raster(vertices, frame)
            if not (_grown(mask) & drawn).any():
                break
        shapes.append(vertices)
        drawn |= mask
    return shapes, drawn


def _placed(
    rng: np.random.Generator, vertices: Vertices, frame: tuple[int, int]
) -> Vertices | None:
    """Mirror, turn and move a shape into the frame; None if it does not fit."""
    if rng.random() < 0.5:
        vertices = vertices * [-1, 1]
    angle = rng.uniform(0, 2 * pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = vertices @ turn.T
    turned -= turned.min(axis=0)
    room = np.array(frame) - 2 - turned.max(axis=0)
    if (room < 0).any():
        return None
    return np.asarray(turned + 1 + rng.uniform((0, 0), room) - 0.5)


def _grown(mask: Mask) -> Mask:
    """Add the eight neighbours of every pixel."""
    wide = np.pad(mask, 1)
    tall = wide[:-2] | wide[1:-1] | wide[2:]
    return tall[:, :-2] | tall[:, 1:-1] | tall[:, 2:]
