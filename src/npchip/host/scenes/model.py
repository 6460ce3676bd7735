"""A scene: objects that move before a background, and the noise of a camera."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from npchip.base.errors import InputError
from npchip.host.scenes.backgrounds import Background, Flat
from npchip.host.scenes.motions import Motion
from npchip.host.scenes.rules import Checked, Rule, setting
from npchip.host.scenes.shapes import Shape
from npchip.machine import PIXELS, load_machine

MOST_OBJECTS: Final = 64
MOST_BYTES: Final = 1 << 28
"""Largest clip, frames × rows × columns."""


@dataclass(frozen=True, kw_only=True)
class Object(Checked):
    """A moving object.

    Attributes:
        shape: shape of the object.
        motion: motion of its centre.
        brightness: brightness of every pixel that lies wholly inside.
    """

    shape: Shape
    motion: Motion
    brightness: int = setting(Rule("whole", 0, 255, "brightness of the object"), 220)


def _default_size() -> tuple[int, int]:
    machine = load_machine("default")
    return machine.rows, machine.cols


@dataclass(frozen=True, kw_only=True)
class Scene(Checked):
    """Settings that determine a clip.

    Attributes:
        objects: objects, of which later ones hide earlier ones.
        background: background of the objects.
        frames: number of frames.
        size: (rows, columns) in pixels, by default those of the default machine.
        noise: RMS of the noise of every pixel in every frame, in LSB.
        seed: seed of noise and texture.

    Raises:
        InputError: NP283 or NP284 a setting, NP286 a clip larger than 2²⁸ pixels.
    """

    objects: tuple[Object, ...]
    background: Background = field(default_factory=Flat)
    frames: int = setting(Rule("whole", 1, 100_000, "number of frames"), 30)
    size: tuple[int, int] = field(
        default_factory=_default_size,
        metadata={"rule": Rule("pair", PIXELS, 2048, "rows,columns of the clip", step=PIXELS)},
    )
    noise: float = setting(Rule("number", 0, 32, "noise of every pixel, rms in LSB"), 0.0)
    seed: int = setting(Rule("whole", 0, 2**32 - 1, "seed of noise and texture"), 1)

    def __post_init__(self) -> None:
        """Check the settings; see the class."""
        super().__post_init__()
        object.__setattr__(self, "objects", tuple(self.objects))
        if len(self.objects) > MOST_OBJECTS:
            raise InputError(
                "NP286", f"a scene has at most {MOST_OBJECTS} objects, found {len(self.objects)}"
            )
        rows, cols = self.size
        if self.frames * rows * cols > MOST_BYTES:
            raise InputError(
                "NP286",
                f"{self.frames} frames of {rows} x {cols} pixels are too many:"
                f" at most {MOST_BYTES // (rows * cols)} of this size",
            )
