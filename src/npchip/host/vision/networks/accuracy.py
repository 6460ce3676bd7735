"""Accuracy of a network, with the interval that the number of pictures allows."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.networks.features import Frames
from npchip.host.vision.networks.network import Network
from npchip.host.vision.networks.pictures import PictureSet, as_frames, enlarge

QUANTILE: Final = 1.959964
"""Quantile of the normal distribution for an interval of 95 %."""

CONDITIONS: Final = ("as they are", "shifted by 4 pixels", "noise of σ 10", "contrast × 0.6")
"""Changes that are made to the frames before they are read."""


class Share(NamedTuple):
    """A number of right answers out of a total."""

    right: int
    total: int

    @property
    def value(self) -> float:
        """The share, 0 to 1."""
        return self.right / self.total

    def interval(self) -> tuple[float, float]:
        """Return the bounds of Wilson's interval of 95 %."""
        square = QUANTILE**2
        middle = (self.right + square / 2) / (self.total + square)
        spread = self.right * (self.total - self.right) / self.total + square / 4
        half = QUANTILE / (self.total + square) * spread**0.5
        return middle - half, middle + half

    def __str__(self) -> str:
        low, high = self.interval()
        return f"{self.value:.1%} ({low:.1%} to {high:.1%})"


def frames_of(data: PictureSet, condition: str, seed: int = 1) -> Frames:
    """Return the pictures as frames under one of `CONDITIONS`.

    Args:
        data: the pictures.
        condition: shifts go by 4 pixels to one of the eight sides; the contrast is lost from the
            dark background up.
        seed: of shifts and noise.
    """
    rng = np.random.default_rng((seed, 3))
    enlarged = enlarge(data.pictures)
    if condition == "noise of σ 10":
        enlarged = enlarged + 10 * rng.standard_normal(enlarged.shape, dtype=np.float32)
    elif condition == "contrast × 0.6":
        enlarged = enlarged * np.float32(0.6)
    frames = as_frames(enlarged)
    return _shifted(frames, rng) if condition == "shifted by 4 pixels" else frames


def _shifted(frames: Frames, rng: np.random.Generator) -> Frames:
    sides = np.array([(y, x) for y in (-4, 0, 4) for x in (-4, 0, 4) if (y, x) != (0, 0)])
    rows, cols = frames.shape[1:]
    padded = np.pad(frames, ((0, 0), (4, 4), (4, 4)))
    moved: list[NDArray[np.uint8]] = []
    for frame, (y, x) in zip(
        padded, sides[rng.integers(len(sides), size=len(frames))], strict=True
    ):
        moved.append(frame[4 + y : 4 + y + rows, 4 + x : 4 + x + cols])
    return np.array(moved)


def measure(network: Network, data: PictureSet) -> dict[str, Share]:
    """Return how often a network is right, under each of `CONDITIONS`."""
    return {
        condition: Share(
            int((network.answers(frames_of(data, condition)) == data.labels).sum()), len(data)
        )
        for condition in CONDITIONS
    }
