"""STOP signs as the camera sees them: an octagon with a border and letters, turned away a little.

Sizes are those of the sign R1-1 of the MUTCD (FHWA, public domain), in inches: 30 across, with a
white border of 3/4 and letters of 10. The letters are made of bars: at 64 x 80 pixels their curves
are lost. Greys are what a camera without colour sees of red and white.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from npchip.host.vision.polygons import FRAME, SAMPLES, Vertices, covered

if TYPE_CHECKING:
    from numpy.typing import NDArray

ACROSS, BORDER, HEIGHT, WIDTH, STROKE, PITCH = 30.0, 0.75, 10.0, 4.8, 1.6, 6.0
RED, WHITE = 70, 220
GROUNDS: Final = {"trees": 40, "sky": 200}
"""Grey of what is behind the sign."""

BARS: Final[dict[str, list[tuple[float, float, float, float]]]] = {
    "S": [(0, 0, 1, 0), (0, 0.5, 1, 0.5), (0, 1, 1, 1), (0, 0, 0, 0.5), (1, 0.5, 1, 1)],
    "T": [(0, 0, 1, 0), (0.5, 0, 0.5, 1)],
    "O": [(0, 0, 1, 0), (0, 1, 1, 1), (0, 0, 0, 1), (1, 0, 1, 1)],
    "P": [(0, 0, 1, 0), (0, 0.5, 1, 0.5), (0, 0, 0, 1), (1, 0, 1, 0.5)],
}
"""Ends of the bars of each letter: x, y, x, y, from the upper left corner of its box."""


def octagon(across: float) -> Vertices:
    """Return the corners of an octagon about (0, 0) that stands on a side."""
    angles = np.pi * (np.arange(8) + 0.5) / 4
    radius = across / 2 / np.cos(np.pi / 8)
    return np.asarray(radius * np.stack([np.sin(angles), np.cos(angles)], axis=1))


def letters() -> list[Vertices]:
    """Return the corners of all bars, the middle of the word at (0, 0)."""
    bars = []
    for number, letter in enumerate("STOP"):
        left = (number - 1.5) * PITCH - WIDTH / 2
        for x0, y0, x1, y1 in BARS[letter]:
            rows = [y * (HEIGHT - STROKE) - HEIGHT / 2 for y in (y0, y1)]
            cols = [x * (WIDTH - STROKE) + left for x in (x0, x1)]
            top, bottom = rows[0], rows[1] + STROKE
            first, last = cols[0], cols[1] + STROKE
            bars.append(np.array([[top, first], [top, last], [bottom, last], [bottom, first]]))
    return bars


def stop_sign(rng: np.random.Generator, ground: str) -> tuple[NDArray[np.uint8], Vertices]:
    """Draw a sign of 30 to 56 pixels, turned by up to 30 degrees away and 10 degrees in the frame.

    Args:
        rng: source of the random numbers.
        ground: a name of `GROUNDS`.

    Returns:
        the picture, uint8, shape `FRAME`, and the corners of the sign, shape (8, 2).
    """
    away, turned = np.radians(rng.uniform((-30, -10), (30, 10)))
    size = rng.uniform(30, 56) / ACROSS
    turn = np.array([[np.cos(turned), np.sin(turned)], [-np.sin(turned), np.cos(turned)]])
    place = turn * size * [1, np.cos(away)]  # columns shrink as the sign turns away
    corners = octagon(ACROSS) @ place.T
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = rng.uniform(1 - low, np.array(FRAME) - 2 - high)
    picture = np.full(FRAME, float(GROUNDS[ground]))
    parts = [(octagon(ACROSS), WHITE), (octagon(ACROSS - 2 * BORDER), RED)]
    for shape, grey in [*parts, *((bar, WHITE) for bar in letters())]:
        part = covered(shape @ place.T + middle) / SAMPLES**2
        picture += part * (grey - picture)
    return picture.round().astype(np.uint8), corners + middle
