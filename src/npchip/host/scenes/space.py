"""Motions of the middle of a ball in space, in metres.

x and y are horizontal, z is up, as in `npchip.host.vision.fusion`. Time counts frames from 0.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.host.scenes.motions import Turning, bounce, polynomial
from npchip.host.scenes.rules import Checked, Rule, setting

_FAR = 10_000.0
_PLACE = Rule("triple", -_FAR, _FAR, "where its middle is in the first frame, in metres")
_VELOCITY = Rule("triple", -_FAR, _FAR, "metres that it moves in each frame")
_STILL: Final = (0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class SpaceMotion(Checked, ABC):
    """Base of all motions in space."""

    @abstractmethod
    def positions(self, frames: int, radius: float) -> NDArray[np.float64]:
        """Return the middle of the ball in every frame.

        Args:
            frames: number of frames, T.
            radius: radius of the ball in metres, for motions with a floor.

        Returns:
            float64, shape (T, 3), metres.
        """


@dataclass(frozen=True, kw_only=True)
class Straight(SpaceMotion):
    """A motion with constant velocity."""

    start: tuple[float, float, float] = setting(_PLACE)
    velocity: tuple[float, float, float] = setting(_VELOCITY, _STILL)

    def positions(self, frames: int, radius: float) -> NDArray[np.float64]:  # noqa: ARG002
        """Return ``start + velocity t``."""
        return polynomial(frames, self.start, self.velocity, _STILL)


@dataclass(frozen=True, kw_only=True)
class Accelerated(Straight):
    """A motion with constant acceleration."""

    acceleration: tuple[float, float, float] = setting(
        Rule("triple", -_FAR, _FAR, "accelerating: what velocity gains in each frame")
    )

    def positions(self, frames: int, radius: float) -> NDArray[np.float64]:  # noqa: ARG002
        """Return ``start + velocity t + acceleration t² / 2``."""
        return polynomial(frames, self.start, self.velocity, self.acceleration)


@dataclass(frozen=True, kw_only=True)
class Orbiting(Turning, SpaceMotion):
    """A motion on a circle, level or tilted about the x axis, that may rise."""

    center: tuple[float, float, float] = setting(
        Rule("triple", -_FAR, _FAR, "circular: the circle's centre")
    )
    orbit: float = setting(Rule("number", 0, _FAR, "circular: the circle's radius in metres"))
    period: float = setting(Rule("number", -1e6, 1e6, "circular: frames for one turn"))
    phase: float = setting(Rule("number", -360, 360, "circular: degrees at first; 0 is +x"), 0.0)
    tilt: float = setting(Rule("number", -90, 90, "circular: degrees about the x axis"), 0.0)
    rise: float = setting(
        Rule("number", -_FAR, _FAR, "circular: metres upwards in each frame"), 0.0
    )

    def positions(self, frames: int, radius: float) -> NDArray[np.float64]:  # noqa: ARG002
        """Return ``center + orbit (cos a, sin a cos tilt, sin a sin tilt) + (0, 0, rise t)``."""
        t = np.arange(frames)
        angle = np.radians(self.phase) + 2 * np.pi * np.fmod(t / self.period, 1)
        tilt = math.radians(self.tilt)
        away = np.sin(angle) * self.orbit
        around = [np.cos(angle) * self.orbit, away * math.cos(tilt), away * math.sin(tilt)]
        return np.stack(around, -1) + self.center + np.outer(t, [0, 0, self.rise])


@dataclass(frozen=True, kw_only=True)
class Jumping(Straight):
    """A motion of a ball that falls and bounces off a level floor."""

    gravity: float = setting(
        Rule("number", 0, _FAR, "bouncing: what velocity loses upwards in each frame")
    )
    restitution: float = setting(
        Rule("number", 0, 1, "bouncing: part of the speed that a bounce keeps"), 1.0
    )
    floor: float = setting(Rule("number", -_FAR, _FAR, "bouncing: height of the floor"), 0.0)

    def positions(self, frames: int, radius: float) -> NDArray[np.float64]:
        """Return parabolas in z, exact at the bounces too, and straight lines in x and y.

        Raises:
            InputError: NP287, the ball starts in the floor.
        """
        low = self.floor + radius
        if self.start[2] < low:
            raise InputError(
                "NP287",
                f"bouncing: a ball of radius {radius:g} above a floor at {self.floor:g} starts at"
                f" z = {low:g} or higher, found {self.start[2]:g}",
            )
        path = super().positions(frames, radius)
        walls = (low, 4 * _FAR * (1 + frames))  # no ceiling
        path[:, 2] = bounce(
            frames, self.start[2], self.velocity[2], -self.gravity, walls, keeps=self.restitution
        )
        return path


SPACE_MOTIONS: Final[Mapping[str, type[SpaceMotion]]] = {
    "linear": Straight,
    "accelerating": Accelerated,
    "circular": Orbiting,
    "bouncing": Jumping,
}
