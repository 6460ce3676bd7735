"""Backgrounds of the objects, the same in all frames."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.scenes.rules import Checked, Rule, setting

_LEVEL = Rule("number", 0, 255, "brightness")


@dataclass(frozen=True, kw_only=True)
class Background(Checked, ABC):
    """Base of all backgrounds."""

    @abstractmethod
    def picture(self, size: tuple[int, int], seed: int) -> NDArray[np.float64]:
        """Return the brightness of every pixel: float64, shape `size`, not limited to 0..255."""


@dataclass(frozen=True, kw_only=True)
class Flat(Background):
    """The same brightness everywhere."""

    level: float = setting(_LEVEL, 20.0)

    def picture(self, size: tuple[int, int], seed: int) -> NDArray[np.float64]:  # noqa: ARG002
        """See `Background.picture`."""
        return np.full(size, self.level)


@dataclass(frozen=True, kw_only=True)
class Gradient(Background):
    """A change of brightness across the frame; at angle 0 to the right, at 90 downwards."""

    first: float = setting(_LEVEL)
    last: float = setting(_LEVEL)
    angle: float = setting(Rule("number", -360, 360, "direction in degrees"), 0.0)

    def picture(self, size: tuple[int, int], seed: int) -> NDArray[np.float64]:  # noqa: ARG002
        """See `Background.picture`."""
        down, across = math.sin(math.radians(self.angle)), math.cos(math.radians(self.angle))
        rows, cols = np.ogrid[: size[0], : size[1]]
        along = rows * down + cols * across
        along -= along.min()
        part = along / max(float(along.max()), 1.0)
        return np.asarray(self.first + (self.last - self.first) * part)


@dataclass(frozen=True, kw_only=True)
class Texture(Background):
    """Soft random patches around a mean brightness."""

    mean: float = setting(_LEVEL)
    contrast: float = setting(Rule("number", 0, 255, "brightest less darkest patch, at most"))
    grain: int = setting(Rule("whole", 1, 256, "size of a patch in pixels"), 8)

    def picture(self, size: tuple[int, int], seed: int) -> NDArray[np.float64]:
        """Interpolate bilinearly between random corners `grain` pixels apart."""
        shape = (size[0] // self.grain + 2, size[1] // self.grain + 2)
        # NumPy guarantees the raw numbers of PCG64, but not those of a Generator.
        raw = np.random.PCG64(seed).random_raw(shape[0] * shape[1]).reshape(shape)
        corners = (raw >> np.uint64(56)).astype(np.float64) / 255 - 0.5
        row, down = np.divmod(np.arange(size[0])[:, None], self.grain)
        col, across = np.divmod(np.arange(size[1])[None, :], self.grain)
        down, across = down / self.grain, across / self.grain
        upper = corners[row, col] * (1 - across) + corners[row, col + 1] * across
        lower = corners[row + 1, col] * (1 - across) + corners[row + 1, col + 1] * across
        return np.asarray(self.mean + self.contrast * (upper * (1 - down) + lower * down))


BACKGROUNDS: Final[Mapping[str, type[Background]]] = {
    kind.__name__.lower(): kind for kind in (Flat, Gradient, Texture)
}
