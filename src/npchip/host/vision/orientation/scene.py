"""The scene of thesis 3.4: a camera above a right triangle, and its view.

*Thesis*: a pinhole camera whose lens points to the centroid of a 5:12:13 right triangle; camera
positions are random in -500 < x, y < 1500 and 200 < z < 3200 mm (figure 3.11); pictures have
100 x 100 pixels. *Fitted* to its table, as the thesis does not state them: legs of 250 and 600 mm,
the long one along y, the centroid at (500, 500, 0), no roll, a focal length of 100 pixels.
*Decision*: the vertex at the right angle is the highlighted one.

World coordinates are millimetres, z upwards. A place in a frame is (row, column), and whole numbers
are the middles of pixels: pixel (r, c) covers r - 1/2 to r + 1/2 and c - 1/2 to c + 1/2. The camera
stands at *radial* distance from the centroid, *polar* is its angle from the vertical and
*azimuth* its direction on the floor, from x towards y. Since it looks at the centroid, its *pitch*
is polar - 90 degrees (0 looks at the horizon, -90 straight down) and its *yaw*, the direction in
which it looks, is azimuth + 180 degrees.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Wave = Callable[[Floats], Floats]

LEGS: Final = (250.0, 600.0)
"""Legs of the triangle along x and y, in mm; the hypotenuse is 650."""

CENTROID: Final[Floats] = np.array([500.0, 500.0, 0.0])

TRIANGLE: Final[Floats] = np.array([[0, 0, 0], [LEGS[0], 0, 0], [0, LEGS[1], 0]]) - np.array(
    [LEGS[0] / 3, LEGS[1] / 3, 0]
)
"""Vertices in mm from the centroid, shape (3, 3); the highlighted one first, then anticlockwise as
seen from above."""

LOWEST: Final[Floats] = np.array([-500.0, -500.0, 200.0])
HIGHEST: Final[Floats] = np.array([1500.0, 1500.0, 3200.0])

_DRAWN: Final = 4_096  # poses at a time, so that a longer list begins like a shorter one


@dataclass(frozen=True)
class Camera:
    """A pinhole camera; its axis goes through the middle of the frame.

    Attributes:
        rows, cols: size of the frame in pixels.
        focal: focal length in pixels.

    Raises:
        ValueError: a frame or a focal length that no camera has.
    """

    rows: int = 100
    cols: int = 100
    focal: float = 100.0

    def __post_init__(self) -> None:
        """Check the settings, which may come from a file."""
        sizes = (self.rows, self.cols)
        if not all(isinstance(size, int) and 8 <= size <= 2048 for size in sizes):
            raise ValueError(f"a frame has 8 to 2048 rows and columns, found {sizes}")
        if not (isinstance(self.focal, int | float) and 1 <= self.focal <= 1e5):
            raise ValueError(f"a focal length is 1 to 100,000 pixels, found {self.focal}")

    @property
    def middle(self) -> Floats:
        """Row and column of the middle of the frame: float64, shape (2,)."""
        return np.array([(self.rows - 1) / 2, (self.cols - 1) / 2])


THESIS: Final = Camera()
CHIP: Final = Camera(64, 80, 64.0)
"""The frame of the default machine, with the same angle of view from top to bottom (decision)."""

CAMERAS: Final = {"100x100": THESIS, "64x80": CHIP}


# ---- coordinates


def spherical(positions: Floats) -> Floats:
    """Convert positions to radial distance, polar and azimuth angle.

    Args:
        positions: positions, shape (N, 3), in mm.

    Returns:
        shape (N, 3): mm, radians from 0 to pi, radians from -pi to pi.
    """
    x, y, z = (positions - CENTROID).T
    radial = np.sqrt(x * x + y * y + z * z)
    cosine = np.divide(z, radial, out=np.ones_like(z), where=radial > 0)
    return np.stack([radial, np.arccos(np.clip(cosine, -1, 1)), np.arctan2(y, x)], axis=1)


def cartesian(coordinates: Floats, sine: Wave = np.sin, cosine: Wave = np.cos) -> Floats:
    """Undo `spherical`.

    Args:
        coordinates: radial distance in mm, polar and azimuth angle in radians, shape (N, 3).
        sine: sine of angles, exact by default.
        cosine: cosine of angles, exact by default.

    Returns:
        shape (N, 3), in mm.
    """
    radial, polar, azimuth = coordinates.T
    across = radial * sine(polar)
    offsets = [across * cosine(azimuth), across * sine(azimuth), radial * cosine(polar)]
    return np.stack(offsets, axis=1) + CENTROID


def bhaskara_sine(angles: Floats) -> Floats:
    """Approximate sines after Bhaskara I: 16 a (pi - a) / (5 pi² - 4 a (pi - a)) from 0 to pi.

    At most 0.0016 wrong. The thesis (3.4.6) proposes it for the conversion of `cartesian`.
    """
    turn = np.mod(angles, 2 * np.pi)
    half = np.where(turn > np.pi, turn - np.pi, turn)
    product = half * (np.pi - half)
    return np.where(turn > np.pi, -1.0, 1.0) * 16 * product / (5 * np.pi**2 - 4 * product)


def cartesian_bhaskara(coordinates: Floats) -> Floats:
    """Convert as `cartesian` does, with `bhaskara_sine` for all four sines and cosines."""
    return cartesian(coordinates, bhaskara_sine, lambda angles: bhaskara_sine(angles + np.pi / 2))


def yaw_and_pitch(positions: Floats) -> Floats:
    """Find the direction of a camera that looks at the centroid.

    Returns:
        shape (N, 2): yaw, 0 to below 360, and pitch, -90 to 90, in degrees.
    """
    _, polar, azimuth = spherical(positions).T
    yaw = np.mod(np.degrees(azimuth) + 180, 360)
    return np.stack([np.where(yaw >= 360, 0.0, yaw), np.degrees(polar) - 90], axis=1)


def polar_and_azimuth(directions: Floats) -> Floats:
    """Convert the direction of a camera to polar and azimuth angle.

    Args:
        directions: yaw and pitch in degrees, shape (N, 2).

    Returns:
        shape (N, 2), in radians; the azimuth from -pi to pi.
    """
    yaw, pitch = np.radians(directions).T
    azimuth = np.arctan2(-np.sin(yaw), -np.cos(yaw))
    return np.stack([pitch + np.pi / 2, azimuth], axis=1)


def position_of(yaw: float, pitch: float, radial: float) -> Floats:
    """Return the position of a camera that looks at the centroid: shape (3,), in mm."""
    polar, azimuth = polar_and_azimuth(np.array([[yaw, pitch]]))[0]
    return np.asarray(cartesian(np.array([[radial, polar, azimuth]]))[0])


# ---- projection


def in_camera(polar: Floats, azimuth: Floats, points: Floats) -> Floats:
    """Convert points near the centroid to the axes of cameras that look at it without roll.

    Args:
        polar: polar angles in radians, shape (N,).
        azimuth: azimuth angles in radians, shape (N,).
        points: points in mm from the centroid, shape (n, 3).

    Returns:
        shape (N, n, 3): down, to the right, and away from the camera, in mm from the centroid.
    """
    sine, cosine = np.sin(polar), np.cos(polar)
    east, north = np.cos(azimuth), np.sin(azimuth)
    forward = np.stack([-sine * east, -sine * north, -cosine], axis=1)
    right = np.stack([-north, east, np.zeros_like(east)], axis=1)
    down = np.cross(forward, right)
    return np.stack([down @ points.T, right @ points.T, forward @ points.T], axis=2)


def project(positions: Floats, points: Floats = TRIANGLE, camera: Camera = THESIS) -> Floats:
    """Project points near the centroid into the frames of cameras.

    Args:
        positions: positions of the cameras, shape (N, 3), in mm.
        points: points in mm from the centroid, shape (n, 3).
        camera: frame and focal length of all cameras.

    Returns:
        shape (N, n, 2): row and column; NaN for a point that is not in front of a camera.
    """
    radial, polar, azimuth = spherical(positions).T
    seen = in_camera(polar, azimuth, points)
    depth = radial[:, np.newaxis] + seen[:, :, 2]
    scale = np.divide(camera.focal, depth, out=np.full_like(depth, np.nan), where=depth > 0)
    return np.asarray(camera.middle + seen[:, :, :2] * scale[:, :, np.newaxis])


def fits(positions: Floats, camera: Camera = THESIS) -> NDArray[np.bool_]:
    """Return whether cameras see the whole triangle: bool, shape (N,)."""
    places = project(positions, camera=camera)
    inside = abs(places - camera.middle) < (camera.rows / 2, camera.cols / 2)
    return np.asarray(inside.all(axis=(1, 2)))


def random_positions(count: int, seed: int, camera: Camera = THESIS) -> Floats:
    """Draw camera positions that see the whole triangle, uniformly from the space of figure 3.11.

    Args:
        count: number of positions.
        seed: seed of the positions; a longer list begins with a shorter one of the same seed.
        camera: the camera that has to see the triangle.

    Returns:
        shape (count, 3), in mm.
    """
    rng = np.random.default_rng(seed)
    found = [np.empty((0, 3))]
    while sum(map(len, found)) < count:
        drawn = rng.uniform(LOWEST, HIGHEST, (_DRAWN, 3))
        found.append(drawn[fits(drawn, camera)])
    return np.concatenate(found)[:count]


# ---- 3.4.1: the bottom-view camera


def height_from_scale(side: Floats, camera: Camera = THESIS, length: float = LEGS[1]) -> Floats:
    """Find the height in mm of a camera that looks straight down, by the scale alone (3.4.1).

    Args:
        side: length of a side in the picture, in pixels.
        camera: the camera, of which the focal length counts.
        length: length of the same side on the floor, in mm.
    """
    return camera.focal * length / side
