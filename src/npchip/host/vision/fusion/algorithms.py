"""The six algorithms of thesis 2.2, table 2.1.

Each is written once, for any `npchip.host.vision.fusion.arithmetic.Arithmetic`, and returns
(x, y, z). Equations are those of ``docs/fusion.md``, which derives them: 2.4, 2.6 and 2.7 are
printed with mistakes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from npchip.host.vision.fusion.arithmetic import Arithmetic
from npchip.host.vision.fusion.camera import Rig

Point = tuple[Any, Any, Any]


class Constants:
    """Constants of a rig as numbers of one kind, made at their first use.

    Args:
        m: the kind of numbers.
        rig: the cameras.
    """

    def __init__(self, m: Arithmetic, rig: Rig) -> None:
        self._make = m.constant
        self._one, self._two = rig.camera1, rig.camera2
        self.shift1, self.shift2 = rig.camera1.shift or 0, rig.camera2.shift or 0

    x1 = cached_property(lambda self: self._make(self._one.position[0]))
    y1 = cached_property(lambda self: self._make(self._one.position[1]))
    z1 = cached_property(lambda self: self._make(self._one.position[2]))
    x2 = cached_property(lambda self: self._make(self._two.position[0]))
    y2 = cached_property(lambda self: self._make(self._two.position[1]))
    z2 = cached_property(lambda self: self._make(self._two.position[2]))
    ratio1 = cached_property(lambda self: self._make(self._one.ratio))
    ratio2 = cached_property(lambda self: self._make(self._two.ratio))
    one = cached_property(lambda self: self._make(1))

    @cached_property
    def right(self) -> Any:
        """x1 - x2."""
        return self._make(self._one.position[0] - self._two.position[0])

    @cached_property
    def ahead(self) -> Any:
        """y2 - y1."""
        return self._make(self._two.position[1] - self._one.position[1])

    @cached_property
    def ahead_in_pixels(self) -> Any:
        """The ratio of camera 2 times y2 - y1."""
        return self._make(self._two.ratio * (self._two.position[1] - self._one.position[1]))

    @cached_property
    def square(self) -> Any:
        """Product of the ratios."""
        return self._make(self._one.ratio * self._two.ratio)


@dataclass(frozen=True)
class Sight:
    """Measurements of one object by the two cameras, or of many.

    Attributes:
        h1, v1, h2, v2: offsets in pixels from the middle of the frames (c1h, c1v, c2h, c2v).
        f1, f2: distances in pixels from the middle of the cell (fdx, fdy).
        x, y, z: the entry of the lookup table for the cells, in metres.
    """

    h1: Any
    v1: Any
    h2: Any
    v2: Any
    f1: Any = None
    f2: Any = None
    x: Any = None
    y: Any = None
    z: Any = None


Core = Callable[[Arithmetic, Constants, Sight], Point]
By = tuple[Callable[[Any], Any], Callable[[Any], Any]]
"""Divisions by the ratio of camera 1 and of camera 2."""


def vector(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Intersect the vectors by u (2.3): u metres to a pixel at the object's distance."""
    del m
    u = (c.ahead_in_pixels + s.h2 * c.right) / (c.square - s.h1 * s.h2)
    return c.x1 + u * s.h1, c.y1 + u * c.ratio1, c.z1 + u * s.v1


def similarity(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Intersect by similar triangles in the x, y plane (2.4 and 2.5, corrected)."""
    t1, t2 = s.h1 / c.ratio1, s.h2 / c.ratio2
    b1 = m.narrow(c.ahead + t2 * c.right) / m.narrow(c.one - t1 * t2)
    y = c.y1 + b1
    return c.x1 + t1 * b1, y, c.z1 + (y - c.y1) * (s.v1 / c.ratio1)


def lookup(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Take the entry of the table (thesis 2.2.3)."""
    del m, c
    return s.x, s.y, s.z


def improved_dx(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Keep the coordinate of the table whose error is estimated to be smaller (2.6, 2.7)."""
    dx = m.magnitude(s.f1 * (s.y - c.y1))
    dy = m.magnitude(s.f2 * (s.x - c.x2))
    return _improved(m, c, s, (dx, dy), dividing(c))


def improved_fdx(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Do as `improved_dx`, but compare in pixels only."""
    return _improved(m, c, s, (m.magnitude(s.f1), m.magnitude(s.f2)), dividing(c))


def improved_2n(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Do as `improved_fdx` with ratios that are powers of two, so that divisions are shifts."""
    return _improved(m, c, s, (m.magnitude(s.f1), m.magnitude(s.f2)), shifting(m, c))


def _improved(m: Arithmetic, c: Constants, s: Sight, errors: tuple[Any, Any], by: By) -> Point:
    """Apply equations 2.7 where errors[0] < errors[1] (x is better), else 2.6."""
    by1, by2 = by

    def keep_table_x() -> tuple[Any, Any]:
        y = c.y2 + by2((s.x - c.x2) * s.h2)
        return c.x1 + by1((y - c.y1) * s.h1), y

    x, y = m.choose(errors, keep_table_x, lambda: refined(c, s, s.y, by))
    return x, y, c.z1 + by1((y - c.y1) * s.v1)


def refined(c: Constants, s: Sight, y: Any, by: By) -> tuple[Any, Any]:
    """Return the x of a y on the ray of camera 1, and the y of that x on the ray of camera 2."""
    by1, by2 = by
    x = c.x1 + by1((y - c.y1) * s.h1)
    return x, c.y2 + by2((x - c.x2) * s.h2)


def dividing(c: Constants) -> By:
    """Return the divisions by the ratios."""
    return lambda value: value / c.ratio1, lambda value: value / c.ratio2


def shifting(m: Arithmetic, c: Constants) -> By:
    """Return the divisions by ratios that are powers of two, as shifts."""
    return lambda value: m.shifted(value, c.shift1), lambda value: m.shifted(value, c.shift2)
