"""Random motions, as the simulation of thesis 2.1.3 draws them.

The thesis states neither speeds nor radii nor gravity: all ranges are decisions, chosen so that the
figures of docs/prediction.md come near those of the project's prototypes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from npchip.host.vision.prediction import FRAME

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from npchip.host.vision.prediction import Centers, Frames

RADIUS: Final = 5.0
"""Of the discs that `discs` draws; paths keep a pixel more from the border."""

MARGIN: Final = RADIUS + 1


@dataclass(frozen=True)
class Path:
    """A true motion.

    Attributes:
        centers: float64, shape (T, 2): row and column of the centre in every frame.
        impacts: bool, shape (T,): the object has hit the ground since the frame before.
    """

    centers: NDArray[np.float64]
    impacts: NDArray[np.bool_]

    def rounded(self) -> Centers:
        """Centres as the chip could know them: int64, shape (T, 2), rounded half up."""
        return np.floor(self.centers + 0.5).astype(np.int64)


_LEAST = 8
"""Frames that a path has at least: the robust predictor speaks from the fifth on."""


def accelerating(
    rng: np.random.Generator,
    acceleration: float,
    frames: int = 24,
    size: tuple[int, int] = FRAME,
    margin: float = MARGIN,
) -> Path:
    """Constant acceleration of this size and either sign in each axis; 0 is uniform motion.

    The path begins anywhere at up to 2 + 4 sqrt(acceleration) pixels a frame in each axis and ends
    where it would come nearer than `margin` to the border, after 8 to `frames` frames.
    """
    top = 2 + 4 * acceleration**0.5
    k = np.arange(frames)[:, None]

    def draw() -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        start = rng.uniform((margin, margin), (size[0] - 1 - margin, size[1] - 1 - margin))
        velocity = rng.uniform(-top, top, 2)
        a = acceleration * rng.choice([-1, 1], 2)
        return start + velocity * k + a / 2 * k**2, np.zeros(frames, bool)

    return _first_inside(draw, size, margin)


def uniform(
    rng: np.random.Generator,
    frames: int = 24,
    size: tuple[int, int] = FRAME,
    margin: float = MARGIN,
) -> Path:
    """Uniform linear motion: `accelerating` without acceleration."""
    return accelerating(rng, 0, frames, size, margin)


def circular(
    rng: np.random.Generator,
    *,
    frames: int = 24,
    size: tuple[int, int] = FRAME,
    margin: float = MARGIN,
    radius: tuple[float, float] = (9, 18),
    turn: tuple[float, float] = (0.28, 0.42),
) -> Path:
    """Uniform motion on a circle; `radius` in pixels, `turn` in radians a frame (fitted)."""
    k = np.arange(frames)

    def draw() -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        r = rng.uniform(*radius)
        angle = rng.uniform(0, 2 * np.pi) + rng.choice([-1, 1]) * rng.uniform(*turn) * k
        low = margin + r
        middle = rng.uniform((low, low), (size[0] - 1 - low, size[1] - 1 - low))
        return middle + r * np.stack([np.sin(angle), np.cos(angle)], 1), np.zeros(frames, bool)

    return _first_inside(draw, size, margin)


def bouncing(
    rng: np.random.Generator,
    *,
    frames: int = 24,
    size: tuple[int, int] = FRAME,
    margin: float = MARGIN,
    gravity: tuple[float, float] = (0.3, 1.0),
    restitution: tuple[float, float] = (0.7, 0.95),
) -> Path:
    """A ball that falls, hits the ground `margin` above the lowest row, and rises less (fitted).

    Args:
        rng: source of all randomness.
        frames: most frames; at least 8 and one impact are given.
        size: (rows, columns) of the frame.
        margin: nearest that the centre comes to the border.
        gravity: range in pixels per frame squared.
        restitution: range of the share of the speed that an impact leaves.
    """
    ground = size[0] - 1 - margin

    def draw() -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        g, keeps = rng.uniform(*gravity), rng.uniform(*restitution)
        col, speed = rng.uniform(margin, size[1] - 1 - margin), rng.uniform(-3, 3)
        y, v = rng.uniform(margin, size[0] / 2), rng.uniform(-2, 2)
        rows, impacts = np.empty(frames), np.zeros(frames, bool)
        for k in range(frames):
            rows[k] = y
            y, v, impacts[(k + 1) % frames] = _fall(y, v, g, ground, keeps)
        impacts[0] = False
        return np.stack([rows, col + speed * np.arange(frames)], 1), impacts

    while True:
        path = _first_inside(draw, size, margin)
        if path.impacts.any():
            return path


def _fall(y: float, v: float, g: float, ground: float, keeps: float) -> tuple[float, float, bool]:
    """Height and speed a frame later, and whether the ground was hit, however often."""
    left, hit = 1.0, False
    for _ in range(20):  # a ball that hardly bounces any more comes to rest
        if y + v * left + g / 2 * left**2 <= ground:
            return y + v * left + g / 2 * left**2, v + g * left, hit
        until = (-v + (v * v + 2 * g * (ground - y)) ** 0.5) / g
        y, v, left, hit = ground, -keeps * (v + g * until), left - until, True
    return ground, 0.0, hit


def _first_inside(
    draw: Callable[[], tuple[NDArray[np.float64], NDArray[np.bool_]]],
    size: tuple[int, int],
    margin: float,
) -> Path:
    """Draw until a path stays inside for at least `_LEAST` frames; what comes after is cut."""
    for _ in range(5_000):
        centers, impacts = draw()
        highest = np.array(size) - 1 - margin
        outside = ((centers < margin) | (centers > highest + 1e-9)).any(axis=1)
        length = int(np.argmax(outside)) if outside.any() else len(centers)
        if length >= _LEAST:
            return Path(centers[:length], impacts[:length])
    raise ValueError(f"no such path of {_LEAST} frames in {size[0]} × {size[1]} pixels")


def discs(path: Path, size: tuple[int, int] = FRAME) -> Frames:
    """Draw a light disc of `RADIUS` along a path; pixels at its rim are partly lit.

    Returns:
        uint8, shape (T, rows, columns): 230 on 30.
    """
    rows, cols = np.ogrid[: size[0], : size[1]]
    clip = np.empty((len(path.centers), *size), np.uint8)
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
"""The motions of the error table by name; a is the acceleration in each axis."""
