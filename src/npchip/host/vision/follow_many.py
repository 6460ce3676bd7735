"""Follow up to four moving objects: the model of ``asm/follow_many.s`` and its larger companion.

The mask is that of `npchip.host.vision.foreground`. Tracks take turns: each takes its object out of
the mask, and what is left may begin a new one. docs/tracking.md shows what this reaches on real
video.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from npchip.host.vision.follow import COAST, SMALLEST, SURPRISE, camera_moves, grow, signed
from npchip.host.vision.foreground import NP, Bytes, Foreground, Mask

TRACKS: Final = 4
"""Objects that are followed at the same time."""
REACH: Final = 12
"""Half the side of the square in which an object may lie."""
SEED: Final = SURPRISE
"""Half the side of the square in which it is looked for: a wider one reaches its neighbours."""
LARGEST: Final = 255
"""Area that stands for any larger one."""


class Seen(NamedTuple):
    """One object in one frame.

    Attributes:
        id: number of its track: 1, 2 and so on, after 255 again 0.
        row: row of its centroid, whole pixels.
        col: column of its centroid.
        area: number of its pixels, at most 255.
        predicted_row: row of the pixel expected ``ahead`` frames later.
        predicted_col: its column.
    """

    id: int
    row: int
    col: int
    area: int
    predicted_row: int
    predicted_col: int


class Room(NamedTuple):
    """The range of places.

    Attributes:
        bits: of a place in the program, 8 of them behind the point.
        shape: rows and columns; a place is less, in whole pixels.
    """

    bits: int
    shape: tuple[int, int]


@dataclass
class Track:
    """A track; places and velocities are (row, column) in 256ths of a pixel.

    Smoothing, if there is any, shifts the picture by half a pixel; only the outputs take that back.

    Attributes:
        expected: place expected in the next frame.
        velocity: what it moves by in a frame.
        life: frames left without the object; 0: no track; 1: it is new, or lost for long.
        number: its identity.
    """

    expected: list[int] = field(default_factory=lambda: [0, 0])
    velocity: list[int] = field(default_factory=lambda: [0, 0])
    life: int = 0
    number: int = 0

    def square(self, shape: tuple[int, int], half: int) -> Mask:
        """Give the pixels of a frame within ``half`` of the expected one."""
        row, col = (place >> 8 for place in self.expected)
        square = np.zeros(shape, np.bool_)
        square[max(row - half, 0) : row + half, max(col - half, 0) : col + half] = True
        return square

    def measure(self, place: tuple[int, int]) -> None:
        """Take an eighth of what the expected place has missed by into the velocity.

        An object that is new, lost for long or surprising along an axis starts at rest.
        """
        for axis in (0, 1):
            missed = place[axis] - self.expected[axis]
            if self.life > 1 and -SURPRISE << 8 <= missed < SURPRISE << 8:
                self.velocity[axis] += missed >> 3
            else:
                self.velocity[axis] = 0

    def ahead(self, place: tuple[int, int], frames: int, room: Room) -> list[int]:
        """Extrapolate a place; along an axis that would leave the room it stays."""
        steps = (signed(frames * step, 16) for step in self.velocity)
        there = [(at + step) % (1 << room.bits) for at, step in zip(place, steps, strict=True)]
        return [
            away if away >> 8 < size else at
            for away, at, size in zip(there, place, room.shape, strict=True)
        ]


@dataclass
class ManyFollower:
    """The program's state between frames; feed frames to `step` in order.

    Attributes:
        ahead: frames from a measurement to the predicted place.
        large: as ``asm/follow_many_large.s``, whose places have 16 bits.
        foreground: what differs from the background; that program does not smooth.
    """

    ahead: int = 1
    large: bool = False
    foreground: Foreground = field(default_factory=Foreground)
    _tracks: list[Track] = field(default_factory=lambda: [Track() for _ in range(TRACKS)])
    _newest: int = 0

    def step(self, frame: Bytes) -> list[Seen]:
        """Give the objects seen in the next frame, uint8 with whole NPs, in order of the tracks."""
        mask = self.foreground.mask(frame)
        if camera_moves(mask):
            return []
        free = [track for track in self._tracks if not track.life]
        seen = [self._follow(track, mask) for track in self._tracks if track.life]
        if free:
            self._begin(free[-1], mask)
        return [one for one in seen if one]

    def _follow(self, track: Track, mask: Mask) -> Seen | None:
        """Take the track's object out of the mask, and give it if it is there."""
        rows, cols = mask.shape
        shape = (rows, cols)
        smooths = self.foreground.smooths
        # places that are rounded must have room for that
        room = Room(24 if self.large else 16, shape if smooths else (rows - 1, cols - 1))
        within = mask & track.square(shape, REACH)
        found = grow(within & track.square(shape, SEED), within)
        mask &= ~found
        found_rows, found_cols = np.nonzero(found)
        area = len(found_rows)
        if area < SMALLEST:
            row, col = track.expected
            track.expected = track.ahead((row, col), 1, room)
            track.life -= 1
            return None
        place = (int(found_rows.sum()) << 8) // area, (int(found_cols.sum()) << 8) // area
        track.measure(place)
        track.expected = track.ahead(place, 1, room)
        track.life = COAST
        half = 256 if smooths else 128  # that of smoothing, and that of rounding
        there = [
            min((at + half) >> 8, size - 1)
            for at, size in zip(track.ahead(place, self.ahead, room), shape, strict=True)
        ]
        row, col = ((at + 128) >> 8 for at in place)
        return Seen(track.number, row, col, min(area, LARGEST), there[0], there[1])

    def _begin(self, track: Track, mask: Mask) -> None:
        """Begin a track in the NP with most pixels of the mask; of several, the last one."""
        counts = mask.reshape(mask.shape[0] // NP, NP, -1, NP).sum((1, 3))
        most = counts.max()
        if most < SMALLEST:
            return
        row, col = (int(index) for index in np.argwhere(counts == most)[-1])
        for axis, number in enumerate((row, col)):
            track.expected[axis] = ((NP * number + NP // 2) << 8) | (track.expected[axis] & 0xFF)
        track.life = 1
        self._newest = (self._newest + 1) & 0xFF
        track.number = self._newest
