"""Two cameras at right angles and their projections (thesis 2.2.1, figures 2.7 and 2.8).

World coordinates are metres: x and y horizontal, z up. A camera is an upright pinhole that looks
level along one axis. Its *ratio* R (thesis: a ratio over the number of pixels) is its focal length
in pixels: a point d in front of it and w beside its axis is seen w·R/d pixels beside the middle.

Pixels are (row, column) as in the rest of npchip: rows grow downwards, columns to the right as the
camera sees it, and whole numbers stand for the *middle* of a pixel, which lies half a pixel from
its edge. So the middle of the frame is at (rows/2 - 1/2, cols/2 - 1/2).

The thesis's c1h, c1v, c2h, c2v are `Camera.offsets`: distances from the middle of the frame, with
signs that let the same equations serve cameras that look along +x, -x, +y or -y. With D = y - y1
for camera 1, which is negative in front of a camera that looks along -y,

    x = x1 + D·c1h/R,   z = z1 + D·c1v/R,

and with D = x - x2 for camera 2

    y = y2 + D·c2h/R,   z = z2 + D·c2v/R.

No camera stands as straight as that. One that is *turned* (decision) sees the pixels of an upright
one elsewhere, by a rotation about its pinhole, whatever is in front of it: `Camera.straight` undoes
it, and the equations hold again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Final, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from npchip.base.errors import InputError

Floats: TypeAlias = NDArray[np.float64]
Looks = Literal["+x", "-x", "+y", "-y"]

DIRECTIONS: Final[tuple[str, ...]] = get_args(Looks)
MOST_PIXELS: Final = 4096
MOST_DEGREES: Final = 45
"""Most degrees by which a camera is turned in a direction."""
FARTHEST: Final = 1e6
"""Largest coordinate of a camera, in metres."""


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A pinhole camera that looks along an axis.

    Attributes:
        position: x, y, z of the pinhole, in metres.
        looks: direction of view: ``"+x"``, ``"-x"``, ``"+y"`` or ``"-y"``.
        ratio: focal length in pixels.
        rows, cols: size of its frame.
        turned: degrees by which it is turned from there: first to the right, then upwards, then
            clockwise about its view.

    Raises:
        InputError: NP503, a value that a camera cannot have; the message names it.
    """

    position: tuple[float, float, float]
    looks: Looks
    ratio: float
    rows: int = 64
    cols: int = 80
    turned: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        """Check the values; see the class."""
        self._check_turned()
        try:
            place = tuple(map(float, self.position))
        except (TypeError, ValueError):
            place = ()
        if len(place) != 3 or not all(abs(value) <= FARTHEST for value in place):
            raise _wrong("position", f"[x, y, z] in metres, each within ±{FARTHEST:g}", place)
        object.__setattr__(self, "position", place)
        if self.looks not in DIRECTIONS:
            raise _wrong("looks", ", ".join(DIRECTIONS), self.looks)
        if not _is_number(self.ratio) or not 0 < self.ratio <= FARTHEST:
            raise _wrong("ratio", f"a number above 0, at most {FARTHEST:g}, in pixels", self.ratio)
        for name, size in (("rows", self.rows), ("cols", self.cols)):
            if not _is_number(size) or not 1 <= size <= MOST_PIXELS or size != int(size):
                raise _wrong(name, f"a whole number from 1 to {MOST_PIXELS}", size)

    def _check_turned(self) -> None:
        try:
            angles = tuple(map(float, self.turned))
        except (TypeError, ValueError):
            angles = ()
        if len(angles) != 3 or not all(abs(angle) <= MOST_DEGREES for angle in angles):
            expected = f"[right, up, clockwise] in degrees, each within ±{MOST_DEGREES}"
            raise _wrong("turned", expected, angles)
        object.__setattr__(self, "turned", angles)

    @property
    def upright(self) -> Camera:
        """The same camera, not turned."""
        return replace(self, turned=(0.0, 0.0, 0.0)) if any(self.turned) else self

    @property
    def axis(self) -> int:
        """Index of the axis of view: 0 for x, 1 for y."""
        return "xy".index(self.looks[1])

    @property
    def sign(self) -> int:
        """Direction along the axis of view: 1 or -1."""
        return 1 if self.looks[0] == "+" else -1

    @property
    def shift(self) -> int | None:
        """Exponent n of a ratio 2ⁿ, by which a shift divides; None for another ratio."""
        mantissa, exponent = math.frexp(self.ratio)
        return exponent - 1 if mantissa == 0.5 and exponent > 0 else None

    def project(self, points: ArrayLike) -> tuple[Floats, Floats]:
        """Project points.

        Args:
            points: float64, shape (..., 3), metres.

        Returns:
            pixels, float64 of shape (..., 2), (row, column), also outside the frame, NaN unless the
            depth is above 0; and depths, shape (...), metres in front of the camera.
        """
        away = np.asarray(points, np.float64) - self.position
        along = away[..., self.axis]
        depth = self.sign * along
        scale = self.ratio / np.where(depth > 0, along, np.nan)
        h, v = away[..., 1 - self.axis] * scale, away[..., 2] * scale
        return self.bent(self.pixels(h, v)), depth

    def observe(self, points: ArrayLike) -> Floats:
        """Find the pixels of points.

        Args:
            points: float64, shape (..., 3), metres.

        Returns:
            float64, shape (..., 2): whole (row, column); NaN where the camera does not see a point.
        """
        pixels, _ = self.project(points)
        whole = np.floor(pixels + 0.5)
        whole[~self.inside(whole)] = np.nan
        return whole

    def offsets(self, pixels: ArrayLike) -> tuple[Floats, Floats]:
        """Turn pixels into the thesis's ch and cv.

        Args:
            pixels: (..., 2), (row, column).

        Returns:
            h and v, float64 of shape (...), in pixels from the middle of the frame, signed as the
            equations above need it: h is to the right for a camera along y and to the left for
            one along x; v is up for a camera along a positive axis, else down. The turn of a
            camera is not considered: see `straight`.
        """
        seen = np.asarray(pixels, np.float64)
        right = seen[..., 1] + 0.5 - self.cols / 2
        up = self.rows / 2 - (seen[..., 0] + 0.5)
        return (right if self.axis == 1 else -right), self.sign * up

    def pixels(self, h: ArrayLike, v: ArrayLike) -> Floats:
        """Turn offsets back into pixels, (row, column); see `offsets`."""
        right = np.asarray(h, np.float64) * (1 if self.axis == 1 else -1)
        up = self.sign * np.asarray(v, np.float64)
        return np.stack([self.rows / 2 - 0.5 - up, right + self.cols / 2 - 0.5], -1)

    def straight(self, pixels: ArrayLike) -> Floats:
        """Find the pixels where `upright` would see what this camera sees at `pixels`.

        Args:
            pixels: (..., 2), (row, column).

        Returns:
            float64, shape (..., 2), also outside the frame; NaN beyond 90 degrees.
        """
        return self._rotated(pixels, self._turn().T)

    def bent(self, pixels: ArrayLike) -> Floats:
        """Find the pixels where this camera sees what `upright` would see at `pixels`.

        The inverse of `straight`.
        """
        return self._rotated(pixels, self._turn())

    def _rotated(self, pixels: ArrayLike, turn: Floats) -> Floats:
        seen = np.asarray(pixels, np.float64)
        if not any(self.turned):
            return seen
        middle = np.array([self.rows, self.cols]) / 2 - 0.5
        up, right = np.moveaxis((seen - middle) * [-1, 1] / self.ratio, -1, 0)
        ray = np.stack([right, up, np.ones_like(up)], -1) @ turn.T
        ahead = np.where(ray[..., 2] > 0, ray[..., 2], np.nan)
        return np.stack([-ray[..., 1] / ahead, ray[..., 0] / ahead], -1) * self.ratio + middle

    def _turn(self) -> Floats:
        """Return the rotation from (right, up, forward) of the upright camera to its own."""
        (cp, ct, cr), (sp, st, sr) = (
            function(np.radians(self.turned)) for function in (np.cos, np.sin)
        )
        pan = np.array([[cp, 0, -sp], [0, 1, 0], [sp, 0, cp]])
        tilt = np.array([[1, 0, 0], [0, ct, -st], [0, st, ct]])
        roll = np.array([[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])
        return np.asarray(roll @ tilt @ pan)

    def inside(self, pixels: ArrayLike) -> NDArray[np.bool_]:
        """Return whether pixels lie in the frame; NaN do not."""
        seen = np.asarray(pixels, np.float64)
        size = np.array([self.rows, self.cols])
        return np.asarray(((seen >= -0.5) & (seen < size - 0.5)).all(axis=-1))

    def at_border(self, pixels: ArrayLike) -> NDArray[np.bool_]:
        """Return whether pixels lie in the outermost rows or columns of the frame, or beyond."""
        seen = np.asarray(pixels, np.float64)
        size = np.array([self.rows, self.cols])
        return np.asarray(((seen < 0.5) | (seen >= size - 1.5)).any(axis=-1))

    def point(self, pixels: ArrayLike, depth: ArrayLike) -> Floats:
        """Find the point that is seen at `pixels`, `depth` metres in front of the camera.

        With `distance_from_area` a single camera gives a position (thesis 2.2).

        Args:
            pixels: (..., 2), (row, column).
            depth: (...), metres along the axis.

        Returns:
            float64, shape (..., 3).
        """
        h, v = self.offsets(self.straight(pixels))
        along = self.sign * np.asarray(depth, np.float64)
        point = np.empty((*np.broadcast_shapes(h.shape, along.shape), 3))
        point[..., self.axis] = along
        point[..., 1 - self.axis] = along * h / self.ratio
        point[..., 2] = along * v / self.ratio
        return point + self.position


def calibrate_ratio(length: float, distance: float, pixels: float) -> float:
    """Find a camera's ratio from a known object (thesis 2.2.1).

    Args:
        length: length of the object in metres, seen from the side.
        distance: distance of the object from the camera, in metres.
        pixels: length of the object in the frame.

    Returns:
        the ratio in pixels.

    Raises:
        InputError: NP503, one of them is not above 0.
    """
    for name, value in (("length", length), ("distance", distance), ("pixels", pixels)):
        _check_positive(name, value)
    return pixels * distance / length


def distance_from_area(camera: Camera, area: float, pixels: ArrayLike) -> Floats:
    """Find the distance of an object of known area with one camera (thesis 2.2).

    The object has a simple shape and always shows the camera the same side.

    Args:
        camera: the camera.
        area: area of the object, in square metres.
        pixels: number of pixels that it covers, shape (...).

    Returns:
        float64, shape (...): distance along the camera's axis in metres; NaN where `pixels` is
        not above 0.

    Raises:
        InputError: NP503, `area` is not above 0.
    """
    _check_positive("area", area, ", in square metres")
    covered = np.asarray(pixels, np.float64)
    return camera.ratio * np.sqrt(area / np.where(covered > 0, covered, np.nan))


@dataclass(frozen=True, kw_only=True)
class Rig:
    """Two cameras at right angles (thesis 2.2, figure 2.7).

    Attributes:
        camera1: looks along y.
        camera2: looks along x.
        cell: pixels between entries of the lookup tables; on the chip the width of an NP.

    Raises:
        InputError: NP504, the two do not make a rig; the message says why.
    """

    camera1: Camera
    camera2: Camera
    cell: int = 8

    def __post_init__(self) -> None:
        """Check that the cameras fit together; see the class."""
        first, second = self.camera1, self.camera2
        if first.axis == second.axis:
            raise InputError(
                "NP504",
                f"both cameras look along {first.looks[1]} ({first.looks} and {second.looks}):"
                " they must stand at right angles",
                hint="camera1 looks along +y or -y, camera2 along +x or -x",
            )
        if first.axis == 0:
            raise InputError(
                "NP504",
                f"camera1 looks along {first.looks}, camera2 along {second.looks}",
                hint="exchange them: camera1 looks along +y or -y, camera2 along +x or -x",
            )
        if first.position == second.position:
            raise InputError(
                "NP504",
                f"both cameras stand at {list(first.position)}: nothing can be measured from one"
                " place",
                hint="give camera2 a position of its own",
            )
        sizes = (1, "cols", first.cols), (2, "cols", second.cols), (1, "rows", first.rows)
        for number, name, size in sizes:
            if not _is_number(self.cell) or self.cell < 1 or size % self.cell:
                raise InputError(
                    "NP504",
                    f"cell {self.cell} does not divide the {size} {name} of camera{number}",
                    hint="such as 8, the pixels of a neighborhood processor",
                )

    @property
    def upright(self) -> Rig:
        """The same rig with cameras that are not turned."""
        return replace(self, camera1=self.camera1.upright, camera2=self.camera2.upright)

    @property
    def cells(self) -> tuple[int, int, int]:
        """Number of columns of cells in camera 1 and camera 2, and of rows in camera 1."""
        first, second = self.camera1, self.camera2
        return first.cols // self.cell, second.cols // self.cell, first.rows // self.cell


def _wrong(name: str, expected: str, found: Any) -> InputError:
    text = str(list(found) if isinstance(found, tuple) else found)
    return InputError("NP503", f"{name}: expected {expected}, found {text[:60]}")


def _check_positive(name: str, value: Any, unit: str = "") -> None:
    if not _is_number(value) or not 0 < value < math.inf:
        raise _wrong(name, f"a number above 0{unit}", value)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)
