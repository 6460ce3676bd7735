"""Shapes, and the part of every pixel that they cover. A pixel's middle has whole coordinates."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.host.scenes.rules import Checked, Rule, setting

LARGEST: Final = 4096.0
FULL: Final = 256
"""Coverage of a pixel that lies wholly inside."""

_LINES: Final = 64
"""Lines in a row of pixels; coverage is exact along each line."""

_ANGLE = Rule("number", -3600, 3600, "polygon, rectangle: degrees it is turned at first")
_ROTATION = Rule(
    "number", -360, 360, "polygon, rectangle: degrees it turns in each frame, clockwise"
)

Points = NDArray[np.float64]
"""float64, shape (n, 2): (row, column)."""


@dataclass(frozen=True, kw_only=True)
class Shape(Checked, ABC):
    """Base of all shapes, with coordinates relative to their centre."""

    @abstractmethod
    def outline(self, frame: int) -> Points | None:
        """Return the corners in frame number `frame`; None for a shape without corners."""

    @property
    @abstractmethod
    def reach(self) -> tuple[float, float]:
        """Largest distance from its centre in rows and columns, in any frame."""

    def crossings(self, lines: NDArray[np.float64], frame: int) -> list[NDArray[np.float64]]:
        """Find the crossings of its border with horizontal lines.

        Args:
            lines: float64, shape (n,): rows of the lines.
            frame: number of the frame.

        Returns:
            float64 of shape (2, n) for each section of the border: column of the crossing, and
            direction, +1 or -1, or 0 without a crossing.
        """
        corners = self.outline(frame)
        assert corners is not None
        return [_edge(a, b, lines) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]


@dataclass(frozen=True, kw_only=True)
class Dot(Shape):
    """A square of one pixel."""

    def outline(self, frame: int) -> Points:  # noqa: ARG002 - a dot does not turn
        """Return the corners of the pixel."""
        return _rectangle(1, 1)

    @property
    def reach(self) -> tuple[float, float]:
        """Half a pixel."""
        return 0.5, 0.5


@dataclass(frozen=True, kw_only=True)
class Disc(Shape):
    """A filled circle."""

    radius: float = setting(Rule("number", 0.5, LARGEST, "disc: radius in pixels"))

    def outline(self, frame: int) -> None:
        """Return None, as a disc has no corners."""

    @property
    def reach(self) -> tuple[float, float]:
        """The radius."""
        return self.radius, self.radius

    def crossings(self, lines: NDArray[np.float64], frame: int) -> list[NDArray[np.float64]]:  # noqa: ARG002
        """See `Shape.crossings`."""
        return disc_crossings(lines, self.radius)


@dataclass(frozen=True, kw_only=True)
class Turning(Shape):
    """Base of shapes with corners that may turn about their centre."""

    angle: float = setting(_ANGLE, 0.0)
    rotation: float = setting(_ROTATION, 0.0)

    @property
    @abstractmethod
    def _corners(self) -> Points:
        """Corners without rotation."""

    def outline(self, frame: int) -> Points:
        """Return the corners, turned clockwise as seen on the screen."""
        turn = math.radians(math.fmod(self.angle + self.rotation * frame, 360))
        if not turn:
            return self._corners
        rows, cols = self._corners.T
        sine, cosine = math.sin(turn), math.cos(turn)
        return np.stack([rows * cosine + cols * sine, cols * cosine - rows * sine], axis=1)

    @property
    def reach(self) -> tuple[float, float]:
        """Distance of the farthest corner, or half height and width of a shape that never turns."""
        if self.rotation:
            farthest = float(np.hypot(*self._corners.T).max())
            return farthest, farthest
        height, width = np.abs(self.outline(0)).max(axis=0)
        return float(height), float(width)


@dataclass(frozen=True, kw_only=True)
class Rectangle(Turning):
    """A filled rectangle."""

    height: float = setting(Rule("number", 0.5, LARGEST, "rectangle: height in pixels"))
    width: float = setting(Rule("number", 0.5, LARGEST, "rectangle: width in pixels"))

    @cached_property
    def _corners(self) -> Points:
        return _rectangle(self.height, self.width)


@dataclass(frozen=True, kw_only=True)
class Polygon(Turning):
    """A filled polygon with any coordinates; its centroid becomes its centre."""

    vertices: tuple[tuple[float, float], ...] = setting(
        Rule("pairs", -LARGEST, LARGEST, "polygon: its corners in order")
    )

    def __post_init__(self) -> None:
        """Check the settings.

        Raises:
            InputError: NP287, the polygon has no area.
        """
        super().__post_init__()
        if abs(self._area) < 0.25:
            raise InputError(
                "NP287",
                f"polygon: the vertices enclose {abs(self._area):.2g} pixels, the least is 0.25",
                hint="give the corners in order around the polygon",
            )

    @cached_property
    def _area(self) -> float:
        here = np.array(self.vertices)
        after = np.roll(here, -1, axis=0)
        return float((here[:, 0] * after[:, 1] - after[:, 0] * here[:, 1]).sum() / 2)

    @cached_property
    def _corners(self) -> Points:
        here = np.array(self.vertices)
        after = np.roll(here, -1, axis=0)
        cross = here[:, 0] * after[:, 1] - after[:, 0] * here[:, 1]
        centroid = ((here + after) * cross[:, None]).sum(axis=0) / (6 * self._area)
        return np.asarray(here - centroid)


SHAPES: Final[Mapping[str, type[Shape]]] = {
    kind.__name__.lower(): kind for kind in (Dot, Disc, Rectangle, Polygon)
}


def coverage(
    shape: Shape, center: tuple[float, float], frame: int, size: tuple[int, int]
) -> tuple[slice, slice, NDArray[np.int64]]:
    """Find the part of each pixel that a shape covers.

    Each row of pixels is measured exactly on 64 lines, so an edge is at most 1/128 pixel off. The
    inside of a polygon that crosses itself is everything that it winds around.

    Args:
        shape: the shape.
        center: (row, column) of its centre.
        frame: number of the frame, for its rotation.
        size: (rows, columns) of the frame.

    Returns:
        rows and columns of the frame around the shape, and their coverage, int64 from 0 to 256.
    """
    down, across = shape.reach
    rows = _touched(center[0], down, size[0])
    cols = _touched(center[1], across, size[1])
    height, width = rows.stop - rows.start, cols.stop - cols.start
    first = rows.start - 0.5 + 0.5 / _LINES
    lines = first + np.arange(height * _LINES) / _LINES
    left = np.arange(cols.start, cols.stop) - 0.5
    inside = np.zeros((len(lines), width))
    for crossing, direction in shape.crossings(lines - center[0], frame):
        column = crossing + center[1]
        inside += direction[:, None] * np.clip(column[:, None] - left, 0, 1)
    covered = np.minimum(np.abs(inside), 1).reshape(height, _LINES, width).sum(axis=1)
    return rows, cols, np.floor(covered * (FULL / _LINES) + 0.5).astype(np.int64)


def disc_crossings(lines: NDArray[np.float64], radius: float) -> list[NDArray[np.float64]]:
    """Find the crossings of a circle with horizontal lines; see `Shape.crossings`."""
    inside = np.abs(lines) < radius
    half = np.sqrt(np.maximum(radius**2 - lines**2, 0))
    return [np.stack([half, inside * 1.0]), np.stack([-half, inside * -1.0])]


def _edge(a: Points, b: Points, lines: NDArray[np.float64]) -> NDArray[np.float64]:
    crosses = (a[0] > lines) != (b[0] > lines)
    fall = b[0] - a[0]
    slope = (b[1] - a[1]) / fall if fall else 0.0
    return np.stack([a[1] + (lines - a[0]) * slope, crosses * math.copysign(1.0, fall)])


def _touched(center: float, reach: float, size: int) -> slice:
    low = math.floor(center - reach + 0.5)
    high = math.ceil(center + reach + 0.5)
    start = min(max(low, 0), size)
    return slice(start, max(start, min(high, size)))


def _rectangle(height: float, width: float) -> Points:
    down, across = height / 2, width / 2
    return np.array([(-down, -across), (-down, across), (down, across), (down, -across)])
