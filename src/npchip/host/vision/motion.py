"""Random motions, as the simulation of thesis 2.1.3 draws them.

The thesis states neither speeds nor radii nor gravity: all ranges are decisions, chosen so that the
figures of docs/prediction.md come near those of the project's prototypes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.prediction import FRAME, Centers, Frames

RADIUS: Final = 5.0
"""Radius of the discs that `discs` draws, in pixels."""

MARGIN: Final = RADIUS + 1
"""Smallest distance of a centre from the border, in pixels."""

_FRAMES: Final = 24
_LEAST: Final = 8
"""Fewest frames of a path: the robust predictor needs five centres."""

_HIGHEST: Final = np.array(FRAME) - 1 - MARGIN
_Drawn = tuple[NDArray[np.float64], NDArray[np.bool_]]


@dataclass(frozen=True)
class Path:
    """A true motion.

    Attributes:
        centers: float64, shape (T, 2): row and column of the centre in every frame.
        impacts: bool, shape (T,): whether the object has hit the ground since the frame before.
    """

    centers: NDArray[np.float64]
    impacts: NDArray[np.bool_]

    def rounded(self) -> Centers:
        """Return the centres as the chip could know them: int64, shape (T, 2), rounded half up."""
        return np.floor(self.centers + 0.5).astype(np.int64)


def accelerating(rng: np.random.Generator, acceleration: float, frames: int = _FRAMES) -> Path:
    """Draw a path of constant acceleration, of this size and either sign in each axis.

    The path begins anywhere at up to 2 + 4 sqrt(acceleration) pixels a frame in each axis and ends
    before it comes nearer than `MARGIN` to the border, after 8 to `frames` frames.

    Raises:
        ValueError: there are no such paths.
    """
    top = 2 + 4 * acceleration**0.5
    k = np.arange(frames)[:, None]

    def draw() -> _Drawn:
        start = rng.uniform(MARGIN, _HIGHEST)
        velocity = rng.uniform(-top, top, 2)
        a = acceleration * rng.choice([-1, 1], 2)
        return start + velocity * k + a / 2 * k**2, np.zeros(frames, bool)

    return _first_inside(draw)


def uniform(rng: np.random.Generator, frames: int = _FRAMES) -> Path:
    """Draw a path of uniform linear motion; see `accelerating`."""
    return accelerating(rng, 0, frames)


def circular(rng: np.random.Generator) -> Path:
    """Draw a path on a circle of 9 to 18 pixels, at 0.28 to 0.42 radians a frame (fitted)."""
    k = np.arange(_FRAMES)

    def draw() -> _Drawn:
        r = rng.uniform(9, 18)
        angle = rng.uniform(0, 2 * np.pi) + rng.choice([-1, 1]) * rng.uniform(0.28, 0.42) * k
        low = MARGIN + r
        middle = rng.uniform(low, np.array(FRAME) - 1 - low)
        return middle + r * np.stack([np.sin(angle), np.cos(angle)], 1), np.zeros(_FRAMES, bool)

    return _first_inside(draw)


def bouncing(
    rng: np.random.Generator,
    *,
    frames: int = _FRAMES,
    gravity: tuple[float, float] = (0.3, 1.0),
    restitution: tuple[float, float] = (0.7, 0.95),
) -> Path:
    """Draw a path of a ball that hits the ground `MARGIN` above the lowest row (fitted).

    Args:
        rng: source of all randomness.
        frames: most frames; the path has at least 8 and one impact.
        gravity: range in pixels per frame squared.
        restitution: range of the part of the speed that an impact leaves.
    """
    ground = float(_HIGHEST[0])

    def draw() -> _Drawn:
        g, keeps = rng.uniform(*gravity), rng.uniform(*restitution)
        col, speed = rng.uniform(MARGIN, _HIGHEST[1]), rng.uniform(-3, 3)
        y, v = rng.uniform(MARGIN, FRAME[0] / 2), rng.uniform(-2, 2)
        rows, impacts = np.empty(frames), np.zeros(frames, bool)
        for k in range(frames):
            rows[k] = y
            y, v, impacts[(k + 1) % frames] = _fall(y, v, g, ground, keeps)
        impacts[0] = False
        return np.stack([rows, col + speed * np.arange(frames)], 1), impacts

    while not (path := _first_inside(draw)).impacts.any():
        pass
    return path


def _fall(y: float, v: float, g: float, ground: float, keeps: float) -> tuple[float, float, bool]:
    """Return height and speed a frame later, and whether the ball has hit the ground."""
    left, hit = 1.0, False
    for _ in range(20):  # a ball that hardly bounces any more comes to rest
        if y + v * left + g / 2 * left**2 <= ground:
            return y + v * left + g / 2 * left**2, v + g * left, hit
        until = (-v + (v * v + 2 * g * (ground - y)) ** 0.5) / g
        y, v, left, hit = ground, -keeps * (v + g * until), left - until, True
    return ground, 0.0, hit


def _first_inside(draw: Callable[[], _Drawn]) -> Path:
    """Draw until a path stays inside for `_LEAST` frames or more, and return that part of it."""
    for _ in range(5_000):
        centers, impacts = draw()
        outside = ((centers < MARGIN) | (centers > _HIGHEST + 1e-9)).any(axis=1)
        length = int(np.argmax(outside)) if outside.any() else len(centers)
        if length >= _LEAST:
            return Path(centers[:length], impacts[:length])
    raise ValueError(f"no such path of {_LEAST} frames in {FRAME[0]} × {FRAME[1]} pixels")


def discs(path: Path) -> Frames:
    """Draw a light disc of `RADIUS` along a path; pixels at its rim are partly lit.

    Returns:
        uint8, shape (T, rows, columns): 230 on 30.
    """
    rows, cols = np.ogrid[: FRAME[0], : FRAME[1]]
    clip = np.empty((len(path.centers), *FRAME), np.uint8)
    for frame, (row, col) in zip(clip, path.centers, strict=True):
        distance = np.hypot(rows - row, cols - col)
        frame[:] = np.round(30 + 200 * np.clip(RADIUS + 0.5 - distance, 0, 1))
    return clip


MOTIONS: Final[dict[str, Callable[[np.random.Generator], Path]]] = {
    "linear": uniform,
    "|a| 0.05–0.3": lambda rng: accelerating(rng, rng.uniform(0.05, 0.3)),
    "|a| = 1": lambda rng: accelerating(rng, 1),
    "|a| = 2": lambda rng: accelerating(rng, 2),
    "|a| = 3": lambda rng: accelerating(rng, 3),
    "|a| 0–3": lambda rng: accelerating(rng, rng.uniform(0, 3)),
    "circular": circular,
    "bouncing": bouncing,
}
"""Motions of the error table by name; a is the acceleration in each axis."""
