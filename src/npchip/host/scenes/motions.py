"""Motions of the centre of an object. Time counts frames from 0; rows grow downwards."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.host.scenes.rules import Checked, Rule, setting

_FAR, _FAST = 100_000.0, 1000.0
_PLACE = Rule("pair", -_FAR, _FAR, "row and column of its centre in the first frame")
_VELOCITY = Rule("pair", -_FAST, _FAST, "rows and columns it moves in each frame")
_LOWEST: Final = 1e-3
"""Height in pixels below which a rebound ends in rest; there would be no end of rebounds."""

Walls = tuple[tuple[float, float], tuple[float, float]]
"""Least and greatest row, least and greatest column that a centre may have."""


@dataclass(frozen=True, kw_only=True)
class Motion(Checked, ABC):
    """Base of all motions."""

    @abstractmethod
    def centers(self, frames: int, walls: Walls) -> NDArray[np.float64]:
        """Return the centre in every frame.

        Args:
            frames: number of frames, T.
            walls: limits of the centre of a bouncing object.

        Returns:
            float64, shape (T, 2): (row, column).
        """


@dataclass(frozen=True, kw_only=True)
class Linear(Motion):
    """A motion with constant velocity, or the rest of an object."""

    start: tuple[float, float] = setting(_PLACE)
    velocity: tuple[float, float] = setting(_VELOCITY, (0.0, 0.0))

    def centers(self, frames: int, walls: Walls) -> NDArray[np.float64]:  # noqa: ARG002
        """Return ``start + velocity t``."""
        return polynomial(frames, self.start, self.velocity, (0.0, 0.0))


@dataclass(frozen=True, kw_only=True)
class Accelerating(Linear):
    """A motion with constant acceleration."""

    acceleration: tuple[float, float] = setting(
        Rule("pair", -_FAST, _FAST, "accelerating: what velocity gains in each frame")
    )

    def centers(self, frames: int, walls: Walls) -> NDArray[np.float64]:  # noqa: ARG002
        """Return ``start + velocity t + acceleration t² / 2``."""
        return polynomial(frames, self.start, self.velocity, self.acceleration)


class Turning(Checked):
    """Base of motions with a period, which cannot be 0."""

    period: float

    def __post_init__(self) -> None:
        """Check the settings.

        Raises:
            InputError: NP284, the period is 0.
        """
        super().__post_init__()
        if not self.period:
            name = type(self).__name__
            raise InputError("NP284", f"{name}.period: expected a number other than 0")


@dataclass(frozen=True, kw_only=True)
class Circular(Turning, Motion):
    """A motion on a circle, clockwise as seen on the screen unless the period is negative."""

    center: tuple[float, float] = setting(
        Rule("pair", -_FAR, _FAR, "circular: row and column of the circle's centre")
    )
    orbit: float = setting(Rule("number", 0, _FAR, "circular: the circle's radius in pixels"))
    period: float = setting(Rule("number", -1e6, 1e6, "circular: frames for one turn"))
    phase: float = setting(
        Rule("number", -360, 360, "circular: degrees at first; 0 is right, 90 is below"), 0.0
    )

    def centers(self, frames: int, walls: Walls) -> NDArray[np.float64]:  # noqa: ARG002
        """Return ``center + orbit (sin a, cos a)`` with ``a = phase + 360° t / period``."""
        turns = [self.phase / 360 + t / self.period for t in range(frames)]
        angles = [2 * math.pi * math.fmod(turn, 1) for turn in turns]
        row, col = self.center
        return np.array(
            [(row + self.orbit * math.sin(a), col + self.orbit * math.cos(a)) for a in angles]
        )


@dataclass(frozen=True, kw_only=True)
class Bouncing(Linear):
    """A motion of a ball whose edge does not cross the borders of the frame."""

    gravity: float = setting(
        Rule("number", -_FAST, _FAST, "bouncing: what velocity gains downwards in each frame"), 0.0
    )
    restitution: float = setting(
        Rule("number", 0, 1, "bouncing: part of the speed that a bounce keeps"), 1.0
    )

    def centers(self, frames: int, walls: Walls) -> NDArray[np.float64]:
        """Return parabolas in rows and straight lines in columns, exact at the bounces too.

        Raises:
            InputError: NP287, the start lies beyond a wall, or the walls are less than a pixel
                apart.
        """
        paths = []
        for axis, name in enumerate(("row", "column")):
            low, high = walls[axis]
            if high - low < 1:
                raise InputError("NP287", f"bouncing: the object leaves no room to move in {name}s")
            if not low <= self.start[axis] <= high:
                raise InputError(
                    "NP287",
                    f"bouncing: at the start its centre must be between {name}s {low:g} and"
                    f" {high:g} for the whole object to be inside, found {self.start[axis]:g}",
                )
            start, speed, pull = self.start[axis], self.velocity[axis], (self.gravity, 0.0)[axis]
            paths.append(bounce(frames, start, speed, pull, walls[axis], keeps=self.restitution))
        return np.array(paths).T


MOTIONS: Final[Mapping[str, type[Motion]]] = {
    kind.__name__.lower(): kind for kind in (Linear, Accelerating, Circular, Bouncing)
}


def polynomial(
    frames: int,
    start: tuple[float, ...],
    velocity: tuple[float, ...],
    acceleration: tuple[float, ...],
) -> NDArray[np.float64]:
    """Return ``start + velocity t + acceleration t² / 2`` in every frame: shape (T, axes)."""
    t = np.arange(frames, dtype=np.float64)[:, None]
    return np.array(start) + np.array(velocity) * t + np.array(acceleration) * (t * t / 2)


def bounce(
    frames: int, x: float, v: float, pull: float, walls: tuple[float, float], *, keeps: float
) -> list[float]:
    """Follow one axis of a bouncing object from event to event.

    Args:
        frames: number of frames.
        x: coordinate at first.
        v: velocity at first, per frame.
        pull: change of the velocity in each frame.
        walls: limits of the coordinate.
        keeps: part of the speed that a bounce keeps.

    Returns:
        the coordinate in every frame.
    """
    path = [x]
    floor = walls[1] if pull > 0 else walls[0]
    if x == floor and not v:
        pull = 0.0
    for _ in range(1, frames):
        left = 1.0
        while (hit := _first_hit(x, v, pull, walls)) is not None and hit[0] <= left:
            after, wall = hit
            left -= after
            x, v = wall, -keeps * (v + pull * after)
            if wall == floor and v * v < 2 * abs(pull) * _LOWEST:
                v = pull = 0.0
        x, v = x + v * left + pull * left * left / 2, v + pull * left
        path.append(min(max(x, walls[0]), walls[1]))
    return path


def _first_hit(
    x: float, v: float, pull: float, walls: tuple[float, float]
) -> tuple[float, float] | None:
    """Return the next (time, wall) at which the object moves towards a wall and reaches it."""
    hits = [
        (time, wall)
        for wall, outwards in zip(walls, (-1, 1), strict=True)
        for time in _times(x - wall, v, pull)
        if time >= 0 and (v + pull * time) * outwards > 0
    ]
    return min(hits, default=None)


def _times(distance: float, v: float, pull: float) -> list[float]:
    """Solve ``distance + v t + pull t² / 2 = 0``; no solutions for an object at rest."""
    if not pull:
        return [-distance / v] if v else []
    square = v * v - 2 * pull * distance
    if square < 0:
        return []
    # The product of the roots gives the second one without cancellation.
    q = -(v + math.copysign(math.sqrt(square), v))
    return [q / pull, 2 * distance / q] if q else [0.0]
