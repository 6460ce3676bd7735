"""Clips for the tests: the bundled real ones, and random synthetic scenes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]

CLIPS = Path(__file__).parents[2] / "examples" / "clips"
THRESHOLDS = (8, 16, 32, 64)
"""Thresholds that some scenes meet exactly, or miss by one."""


def bundled_clips() -> dict[str, Frames]:
    """Every clip of ``examples/clips`` by its stem: uint8, shape (T, 64, 80)."""
    return {path.stem: np.load(path) for path in sorted(CLIPS.glob("*.npy"))}


def synthetic_clip(seed: int, rows: int = 64, cols: int = 80, frames: int = 6) -> Frames:
    """Draw a random scene that depends on nothing but the arguments.

    One scene in two has objects that move, enter and leave before a flat, graded or noisy
    background, with frames in which all stands still and noise below any threshold. The other
    kinds: single pixels at the corners and borders, changes that meet a threshold exactly or
    miss it by one, the whole frame changing, nothing changing, and pure noise.

    Returns:
        uint8, shape (frames, rows, cols).
    """
    rng = np.random.default_rng(seed)
    rare: list[Callable[[np.random.Generator, Frames], None]] = [
        _border_pixels,
        _near_threshold,
        _flicker,
        _still,
        _noise,
    ]
    clip = np.empty((frames, rows, cols), np.uint8)
    clip[:] = _background(rng, rows, cols)
    draw = _objects if rng.random() < 0.5 else rare[int(rng.integers(len(rare)))]
    draw(rng, clip)
    return clip


def _background(rng: np.random.Generator, rows: int, cols: int) -> Frames:
    """Return a flat, graded, chequered or noisy still picture of shape (rows, cols)."""
    level = int(rng.integers(256))
    y, x = np.mgrid[:rows, :cols]
    match int(rng.integers(4)):
        case 0:
            picture = np.full((rows, cols), level)
        case 1:
            picture = level + x * int(rng.integers(-2, 3)) + y * int(rng.integers(-2, 3))
        case 2:
            size = int(rng.integers(1, 9))
            picture = level + ((x // size + y // size) % 2) * int(rng.integers(-128, 128))
        case _:
            picture = rng.integers(256, size=(rows, cols))
    clipped: Frames = np.clip(picture, 0, 255).astype(np.uint8)
    return clipped


def _objects(rng: np.random.Generator, clip: Frames) -> None:
    """Up to three discs, rectangles or dots, each on a straight path, and a little noise."""
    frames, rows, cols = clip.shape
    y, x = np.mgrid[:rows, :cols]
    for _ in range(int(rng.integers(1, 4))):
        shape = int(rng.integers(3))
        brightness = int(rng.integers(256))
        height, width = rng.integers(1, 12, size=2)
        row, col = rng.uniform((-8, -8), (rows + 8, cols + 8))
        speed_row, speed_col = rng.normal(0, 5, size=2)
        for frame in clip:
            match shape:
                case 0:
                    inside = (y - row) ** 2 + (x - col) ** 2 <= height**2
                case 1:
                    inside = (abs(y - row) <= height) & (abs(x - col) <= width)
                case _:
                    inside = (y == round(row)) & (x == round(col))
            frame[inside] = brightness
            if rng.random() < 0.8:  # else it stands still for a frame
                row, col = row + speed_row, col + speed_col
    grain = int(rng.integers(4))
    noise = rng.integers(-grain, grain + 1, size=(frames, rows, cols))
    clip[:] = np.clip(clip + noise, 0, 255)


def _border_pixels(rng: np.random.Generator, clip: Frames) -> None:
    """From frame to frame one pixel, mostly at a corner or on the border, is inverted."""
    frames, rows, cols = clip.shape
    for index in range(1, frames):
        clip[index] = clip[index - 1]
        row, col = int(rng.integers(rows)), int(rng.integers(cols))
        if rng.random() < 0.7:
            row = int(rng.choice([0, 0, 7, 8, rows - 1, rows - 1]))
        if rng.random() < 0.7:
            col = int(rng.choice([0, 0, 7, 8, cols - 1, cols - 1]))
        clip[index, row, col] = 255 - clip[index, row, col]


def _near_threshold(rng: np.random.Generator, clip: Frames) -> None:
    """In every frame a few pixels change by a threshold or by one less, up or down."""
    frames, rows, cols = clip.shape
    clip[0] = np.clip(clip[0], 64, 191)
    for index in range(1, frames):
        clip[index] = clip[index - 1]
        for _ in range(int(rng.integers(4))):
            step = int(rng.choice(THRESHOLDS)) - int(rng.integers(2))
            row, col = int(rng.integers(rows)), int(rng.integers(cols))
            before = int(clip[index - 1, row, col])
            down = before - step >= 0 and (before + step > 255 or rng.random() < 0.5)
            clip[index, row, col] = before - step if down else before + step


def _flicker(rng: np.random.Generator, clip: Frames) -> None:
    """Add to every frame a level of its own, so that all pixels move or none."""
    for frame in clip:
        frame[:] = np.clip(frame.astype(int) + rng.integers(-128, 128), 0, 255)


def _still(_rng: np.random.Generator, _clip: Frames) -> None:
    """Leave the background alone in every frame."""


def _noise(rng: np.random.Generator, clip: Frames) -> None:
    """Fill every frame with noise of its own."""
    clip[:] = rng.integers(256, size=clip.shape)
