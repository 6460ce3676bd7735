"""Pictures of ten classes, their parts, and variants of them to train on.

A picture of 28 x 28 pixels, bright on dark, is enlarged `ENLARGED` times about the middle of the
frame (`enlarge`). To train, every picture is turned, stretched, slanted, shifted and bent a little
(`vary`), and the frame made darker and noisy (`expose`); decisions all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.networks.features import FRAME, Frames

SIZE: Final = 28
ENLARGED: Final = 2.5

Pictures = NDArray[np.uint8]
"""Shape (n, 28, 28), bright on dark."""
Labels = NDArray[np.int64]
"""The class of each picture, 0 to 9."""

TURN: Final = np.radians(12)
STRETCH: Final = 0.12
SLANT: Final = 0.15
SHIFT: Final = 1.5
"""Pixels of the picture."""
BEND: Final = 1.0
"""Standard deviation of the shifts, in pixels of the picture, at `KNOTS` x `KNOTS` places."""
KNOTS: Final = 6
DARKEST: Final = 0.5
"""Least factor of the brightness."""
NOISE: Final = 12.0
"""Largest standard deviation of the noise, in grey levels."""


@dataclass(frozen=True, eq=False)
class PictureSet:
    """Pictures with their classes."""

    pictures: Pictures
    labels: Labels

    def __len__(self) -> int:
        return len(self.labels)

    def part(self, numbers: NDArray[np.int64]) -> PictureSet:
        """Return some of the pictures."""
        return PictureSet(self.pictures[numbers], self.labels[numbers])


@dataclass(frozen=True, eq=False)
class Parts:
    """Parts of a picture set that share no picture.

    Attributes:
        training: four fifths of each class.
        validation: a tenth of each class, to choose between networks.
        test: a tenth of each class, looked at when all is chosen.
    """

    training: PictureSet
    validation: PictureSet
    test: PictureSet


def split(data: PictureSet, seed: int) -> Parts:
    """Split a set at random, each class by itself.

    Args:
        data: the pictures.
        seed: decides which picture is in which part.
    """
    rng = np.random.default_rng((seed, 1))
    parts: tuple[list[int], list[int], list[int]] = ([], [], [])
    for label in range(10):
        numbers = rng.permutation(np.flatnonzero(data.labels == label)).tolist()
        tenth = len(numbers) // 10
        parts[2].extend(numbers[:tenth])
        parts[1].extend(numbers[tenth : 2 * tenth])
        parts[0].extend(numbers[2 * tenth :])
    training, validation, test = (data.part(np.sort(np.array(part, np.int64))) for part in parts)
    return Parts(training, validation, test)


def joined(first: PictureSet, second: PictureSet) -> PictureSet:
    """Return the pictures of both."""
    return PictureSet(
        np.concatenate([first.pictures, second.pictures]),
        np.concatenate([first.labels, second.labels]),
    )


def _between(places: int, values: int, scale: float) -> NDArray[np.float32]:
    """Return the matrix that interpolates between values: places of them about their middle."""
    at = (np.arange(places) - (places - 1) / 2) / scale + (values - 1) / 2
    inside = (at > -0.5) & (at < values - 0.5)
    at = at.clip(0, values - 1)
    low = np.minimum(at.astype(np.int64), values - 2)
    matrix = np.zeros((places, values))
    matrix[np.arange(places), low] = 1 - (at - low)
    matrix[np.arange(places), low + 1] = at - low
    return np.asarray(matrix * inside[:, None], np.float32)


_ROWS: Final = _between(FRAME[0], SIZE, ENLARGED)
_COLS: Final = _between(FRAME[1], SIZE, ENLARGED).T
_BEND: Final = _between(SIZE, KNOTS, SIZE / KNOTS)


def enlarge(pictures: NDArray[np.uint8] | NDArray[np.float32]) -> NDArray[np.float32]:
    """Enlarge pictures bilinearly about the middle of the frame; what reaches beyond is lost.

    Args:
        pictures: shape (n, 28, 28).

    Returns:
        shape (n, 64, 80), 0 beyond the picture.
    """
    return np.asarray(_ROWS @ pictures.astype(np.float32) @ _COLS)


def as_frames(values: NDArray[np.float32]) -> Frames:
    """Round grey levels and limit them to 0 to 255."""
    return np.rint(values).clip(0, 255).astype(np.uint8)


def vary(pictures: Pictures, rng: np.random.Generator) -> NDArray[np.float32]:
    """Turn, stretch, slant, shift and bend each picture at random.

    Args:
        pictures: uint8, shape (n, 28, 28).
        rng: source of the random numbers.

    Returns:
        the same shape.
    """
    count = len(pictures)
    turn = rng.uniform(-TURN, TURN, count)
    stretch = rng.uniform(1 - STRETCH, 1 + STRETCH, (count, 2, 1))
    slant = rng.uniform(-SLANT, SLANT, count)
    cosine, sine = np.cos(turn), np.sin(turn)
    matrix = np.stack([cosine, -sine, sine + slant, cosine], axis=1).reshape(count, 2, 2) * stretch
    grid = np.indices((SIZE, SIZE)).reshape(2, -1) - (SIZE - 1) / 2
    at = (matrix @ grid).reshape(count, 2, SIZE, SIZE).astype(np.float32) + (SIZE - 1) / 2
    at += rng.uniform(-SHIFT, SHIFT, (count, 2, 1, 1)).astype(np.float32)
    bends = BEND * rng.standard_normal((count, 2, KNOTS, KNOTS), dtype=np.float32)
    at += _BEND @ bends @ _BEND.T
    at = at.clip(0, SIZE - 1.001)
    low = at.astype(np.int64)
    y, x = np.moveaxis(at - low, 1, 0)
    first = np.arange(count)[:, None, None] * SIZE**2 + low[:, 0] * SIZE + low[:, 1]
    grey = pictures.astype(np.float32).ravel()
    above = grey[first] * (1 - x) + grey[first + 1] * x
    below = grey[first + SIZE] * (1 - x) + grey[first + SIZE + 1] * x
    return np.asarray(above * (1 - y) + below * y, np.float32)


def expose(frames: NDArray[np.float32], rng: np.random.Generator) -> Frames:
    """Make every frame darker, and every second one noisy, at random.

    Args:
        frames: grey levels, shape (n, 64, 80).
        rng: source of the random numbers.
    """
    darker = rng.uniform(DARKEST, 1, (len(frames), 1, 1)).astype(np.float32)
    seen = frames * darker
    noisy = seen[::2]
    sigma = rng.uniform(0, NOISE, (len(noisy), 1, 1)).astype(np.float32)
    noisy += sigma * rng.standard_normal(noisy.shape, dtype=np.float32)
    return as_frames(seen)
