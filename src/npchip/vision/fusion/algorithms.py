"""The six algorithms of thesis 2.2, table 2.1, and two that beat them without a division.

Each is written once, for any `npchip.vision.fusion.arithmetic.Arithmetic`, and returns (x, y, z).
Equations are those of ``docs/fusion.md``, which derives them: 2.4, 2.6 and 2.7 are printed with
mistakes. Operations are counted by running them on `Counting` (`count`), never stated.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from npchip.errors import InputError
from npchip.vision.fusion.arithmetic import Arithmetic, Counting
from npchip.vision.fusion.camera import Rig

Point = tuple[Any, Any, Any]


class Constants:
    """What is known of a rig before the first frame, as numbers of one kind.

    Args:
        m: the kind of numbers.
        rig: the cameras.
    """

    def __init__(self, m: Arithmetic, rig: Rig) -> None:
        (x1, y1, z1), r1 = rig.camera1.position, rig.camera1.ratio
        (x2, y2, _), r2 = rig.camera2.position, rig.camera2.ratio
        self.x1, self.y1, self.z1, self.x2, self.y2 = map(m.constant, (x1, y1, z1, x2, y2))
        self.ratio1, self.ratio2 = m.constant(r1), m.constant(r2)
        self.right, self.ahead = m.constant(x1 - x2), m.constant(y2 - y1)
        self.ahead_in_pixels, self.square = m.constant(r2 * (y2 - y1)), m.constant(r1 * r2)
        self.one = m.constant(1)
        self.shift1, self.shift2 = rig.camera1.shift or 0, rig.camera2.shift or 0


@dataclass(frozen=True, kw_only=True)
class Sight:
    """What the cameras see of one object, or of many.

    Attributes:
        h1, v1, h2: offsets in pixels from the middle of the frames (c1h, c1v, c2h).
        f1, f2: distances in pixels from the middle of the cell (fdx, fdy).
        x, y, z: the entry of the lookup table for the cells, in metres.
    """

    h1: Any
    v1: Any
    h2: Any
    f1: Any = None
    f2: Any = None
    x: Any = None
    y: Any = None
    z: Any = None


Core = Callable[[Arithmetic, Constants, Sight], Point]
Divide = Callable[[Any, int], Any]


def vector(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Intersection of the vectors by u (2.3): u metres to a pixel at the object's distance."""
    del m  # nothing but + - * /
    u = (c.ahead_in_pixels + s.h2 * c.right) / (c.square - s.h1 * s.h2)
    return c.x1 + u * s.h1, c.y1 + u * c.ratio1, c.z1 + u * s.v1


def similarity(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Similar triangles in the x, y plane (2.4 and 2.5, corrected)."""
    t1, t2 = s.h1 / c.ratio1, s.h2 / c.ratio2
    b1 = m.narrow(c.ahead + t2 * c.right) / m.narrow(c.one - t1 * t2)
    y = c.y1 + b1
    return c.x1 + t1 * b1, y, c.z1 + (y - c.y1) * (s.v1 / c.ratio1)


def lookup(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """The table's entry as it is (thesis 2.2.3)."""
    del m, c
    return s.x, s.y, s.z


def improved_dx(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Keep the coordinate of the table whose error is estimated to be smaller (2.6, 2.7)."""
    dx = m.magnitude(s.f1 * (s.y - c.y1))
    dy = m.magnitude(s.f2 * (s.x - c.x2))
    return _improved(m, c, s, (dx, dy), _dividing(c))


def improved_fdx(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """The same, compared in pixels only."""
    return _improved(m, c, s, (m.magnitude(s.f1), m.magnitude(s.f2)), _dividing(c))


def improved_2n(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """The same with ratios that are powers of two, so that divisions are shifts."""
    return _improved(m, c, s, (m.magnitude(s.f1), m.magnitude(s.f2)), _shifting(m, c))


def keep_y(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Always keep y of the table: one table, no comparison (decision)."""
    by1, by2 = _shifting(m, c)
    x, y = _refined(c, s, s.y, by1, by2)
    return x, y, c.z1 + by1((y - c.y1) * s.v1)


def extra_step(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Always keep y of the table, and go to camera 1 and camera 2 once more (decision).

    Every step multiplies the error in y by t1·t2, which is below 1 wherever the rays meet well.
    """
    by1, by2 = _shifting(m, c)
    _, y = _refined(c, s, s.y, by1, by2)
    x, y = _refined(c, s, y, by1, by2)
    return x, y, c.z1 + by1((y - c.y1) * s.v1)


def _improved(
    m: Arithmetic,
    c: Constants,
    s: Sight,
    errors: tuple[Any, Any],
    divide: tuple[Callable[[Any], Any], Callable[[Any], Any]],
) -> Point:
    """Equations 2.7 where errors[0] < errors[1] (x is better), else 2.6, each with its offsets."""
    by1, by2 = divide

    def keep_table_x() -> tuple[Any, Any]:
        y = c.y2 + by2((s.x - c.x2) * s.h2)
        return c.x1 + by1((y - c.y1) * s.h1), y

    x, y = m.choose(errors, keep_table_x, lambda: _refined(c, s, s.y, by1, by2))
    return x, y, c.z1 + by1((y - c.y1) * s.v1)


def _refined(
    c: Constants, s: Sight, y: Any, by1: Callable[[Any], Any], by2: Callable[[Any], Any]
) -> tuple[Any, Any]:
    """From a y to the x on the ray of camera 1, and from that to the y on the ray of camera 2."""
    x = c.x1 + by1((y - c.y1) * s.h1)
    return x, c.y2 + by2((x - c.x2) * s.h2)


def _dividing(c: Constants) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    return lambda value: value / c.ratio1, lambda value: value / c.ratio2


def _shifting(m: Arithmetic, c: Constants) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    return lambda value: m.shifted(value, c.shift1), lambda value: m.shifted(value, c.shift2)


@dataclass(frozen=True)
class Algorithm:
    """One way from four offsets to a position.

    Attributes:
        title: for tables.
        core: the computation.
        table: which coordinates of the lookup table it reads, such as ``"xy"``.
        power: the ratios must be powers of two.
        thesis: printed in table 2.1: multiplications, divisions, RMS in metres; None for a
            decision of this project.
    """

    title: str
    core: Core
    table: str = ""
    power: bool = False
    thesis: tuple[int, int, float] | None = None


ALGORITHMS: Final[Mapping[str, Algorithm]] = {
    "vector": Algorithm("vector-based", vector, thesis=(6, 2, 0.0199)),
    "similarity": Algorithm("similarity triangle", similarity, thesis=(4, 4, 0.0176)),
    "lut": Algorithm("lookup table", lookup, "xyz", thesis=(0, 0, 0.2924)),
    "improved-dx": Algorithm("improved, dx", improved_dx, "xy", thesis=(5, 3, 0.0431)),
    "improved-fdx": Algorithm("improved, fdx", improved_fdx, "xy", thesis=(3, 3, 0.0487)),
    "improved-2n": Algorithm("improved, 2ⁿ", improved_2n, "xy", power=True, thesis=(3, 0, 0.0487)),
    "keep-y": Algorithm("keep y, 2ⁿ", keep_y, "y", power=True),
    "extra-step": Algorithm("extra step, 2ⁿ", extra_step, "y", power=True),
}
"""By the names that `locate` and the command line take."""


def find(name: str, rig: Rig) -> Algorithm:
    """Return the algorithm `name`, if it can run on the rig.

    Raises:
        InputError: NP505, there is no such algorithm; NP506, it needs ratios that are powers of
            two.
    """
    if name not in ALGORITHMS:
        raise InputError(
            "NP505",
            f"there is no algorithm '{name[:40]}'",
            hint=f"the algorithms are {', '.join(ALGORITHMS)}",
        )
    algorithm = ALGORITHMS[name]
    for number, camera in enumerate((rig.camera1, rig.camera2), 1):
        if algorithm.power and camera.shift is None:
            raise InputError(
                "NP506",
                f"{name} shifts instead of dividing: the ratio of camera{number} must be a power"
                f" of two, found {camera.ratio:g}",
                hint="set the ratio by the focal length, or take improved-fdx",
            )
    return algorithm


def count(name: str, rig: Rig) -> dict[str, int]:
    """Count the operations of one position, by running the algorithm on counting numbers.

    Args:
        name: a key of `ALGORITHMS`.
        rig: the cameras.

    Returns:
        additions (and subtractions), multiplications, divisions, shifts and comparisons.

    Raises:
        InputError: as `find`.
    """
    algorithm = find(name, rig)
    m = Counting()
    numbers = {key: m.constant(1.5) for key in Sight.__dataclass_fields__}
    algorithm.core(m, Constants(m, rig), Sight(**numbers))
    kinds = ("additions", "multiplications", "divisions", "shifts", "comparisons")
    return {kind: m.counts[kind] for kind in kinds}
