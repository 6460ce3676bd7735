"""Ten signs drawn with a pen, to teach a network something else than digits; and ten digits.

A drawing is lines through places in a square of 1 x 1, (row, column) from its upper left corner;
a round one has many short lines. A line is the polygon that `polygons.covered` draws, as those of
STOP signs are.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.networks.pictures import SIZE, Pictures, PictureSet
from npchip.host.vision.polygons import SAMPLES, Vertices, covered

Line = list[tuple[float, float]]
Drawing = list[Line]


def _arc(middle: tuple[float, float], radii: tuple[float, float], first: int, last: int) -> Line:
    """Return a part of an ellipse, in degrees clockwise from the top."""
    angles = np.radians(np.arange(first, last + 1, 15))
    rows, cols = middle[0] - radii[0] * np.cos(angles), middle[1] + radii[1] * np.sin(angles)
    return list(zip(rows.tolist(), cols.tolist(), strict=True))


def _turned(drawing: Drawing, quarters: int) -> Drawing:
    for _ in range(quarters):
        drawing = [[(col, 1 - row) for row, col in line] for line in drawing]
    return drawing


_UP: Final[Drawing] = [[(1, 0.5), (0, 0.5)], [(0.4, 0.1), (0, 0.5), (0.4, 0.9)]]

SIGNS: Final[dict[str, Drawing]] = {
    "up": _UP,
    "right": _turned(_UP, 1),
    "down": _turned(_UP, 2),
    "left": _turned(_UP, 3),
    "plus": [[(0, 0.5), (1, 0.5)], [(0.5, 0), (0.5, 1)]],
    "times": [[(0, 0), (1, 1)], [(0, 1), (1, 0)]],
    "triangle": [[(0, 0.5), (1, 1), (1, 0), (0, 0.5)]],
    "square": [[(0, 0), (0, 1), (1, 1), (1, 0), (0, 0)]],
    "circle": [_arc((0.5, 0.5), (0.5, 0.5), 0, 360)],
    "equals": [[(0.3, 0), (0.3, 1)], [(0.7, 0), (0.7, 1)]],
}
"""Ten signs by name."""

DIGITS: Final[list[Drawing]] = [
    [_arc((0.5, 0.5), (0.5, 0.35), 0, 360)],
    [[(0, 0.55), (1, 0.45)]],
    [[*_arc((0.25, 0.5), (0.25, 0.3), -75, 120), (1, 0.2), (1, 0.85)]],
    [_arc((0.25, 0.5), (0.25, 0.28), -75, 180), _arc((0.75, 0.5), (0.25, 0.32), 0, 255)],
    [[(0, 0.55), (0.65, 0.15), (0.65, 0.9)], [(0.3, 0.65), (1, 0.65)]],
    [[(0, 0.8), (0, 0.3), (0.45, 0.25), *_arc((0.7, 0.45), (0.3, 0.35), 0, 240)]],
    [[(0, 0.65), (0.35, 0.3), *_arc((0.7, 0.5), (0.3, 0.3), 270, 630)]],
    [[(0, 0.15), (0, 0.85), (1, 0.4)]],
    [_arc((0.25, 0.5), (0.25, 0.26), 0, 360), _arc((0.75, 0.5), (0.25, 0.32), 0, 360)],
    [_arc((0.28, 0.5), (0.28, 0.3), 90, 450), [(0.28, 0.8), (1, 0.65)]],
]
"""Digits as they are written by hand."""


def draw(drawing: Drawing, height: float, width: float, pen: float) -> NDArray[np.uint8]:
    """Draw about the middle of a picture.

    Args:
        drawing: the lines.
        height: of the square, in pixels of the picture.
        width: of the square.
        pen: width of the lines.

    Returns:
        uint8, shape (28, 28), bright on dark.
    """
    picture = np.zeros((SIZE, SIZE))
    for line in drawing:
        places = (np.array(line) - 0.5) * (height, width) + (SIZE - 1) / 2
        for start, end in pairwise(places):
            part = covered(_bar(start, end, pen), (SIZE, SIZE)) / SAMPLES**2
            picture = np.maximum(picture, part)
    return np.rint(255 * picture).astype(np.uint8)


def _bar(start: NDArray[np.float64], end: NDArray[np.float64], pen: float) -> Vertices:
    """Return a line as a polygon, longer by half its width at both ends."""
    along = (end - start) / np.hypot(*(end - start)) * pen / 2
    across = np.array([-along[1], along[0]])
    first, last = start - along, end + along
    return np.stack([first - across, last - across, last + across, first + across])


def signs(each: int = 100) -> PictureSet:
    """Draw signs of different sizes with different pens; always the same ones.

    Args:
        each: how many of each.
    """
    rng = np.random.default_rng(0)
    pictures: list[NDArray[np.uint8]] = []
    for drawing in SIGNS.values():
        for height, width in rng.uniform(14, 22, (each, 2)):
            pictures.append(draw(drawing, height, width, rng.uniform(1.5, 3.5)))
    return PictureSet(np.array(pictures), np.repeat(np.arange(len(SIGNS)), each))


def digits() -> Pictures:
    """Draw the digits 0 to 9, one of each."""
    return np.array([draw(drawing, 17, 15, 2.5) for drawing in DIGITS])
