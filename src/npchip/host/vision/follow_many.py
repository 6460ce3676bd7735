"""Follow up to four moving objects: the integer model of ``asm/follow_many.s``.

The mask is made as in `npchip.host.vision.follow`, but each pixel of it may be a ghost. Tracks
take turns: each takes its object out of the mask, and what is left may begin a new one.
docs/tracking.md shows what this reaches on real video.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from npchip.host.vision.follow import (
    COAST,
    NP,
    SMALLEST,
    SURPRISE,
    THRESHOLD,
    Bytes,
    Mask,
    camera_moves,
    grow,
    peel,
    smooth,
    solid,
)

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


@dataclass
class Track:
    """A track; places and velocities are (row, column) in 256ths of a pixel.

    Smoothing shifts the picture by half a pixel; only the outputs take that back.

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

    def ahead(self, place: tuple[int, int], frames: int, shape: tuple[int, int]) -> list[int]:
        """Extrapolate a place; along an axis that would leave the frame it stays."""
        there = [
            (at + frames * step) & 0xFFFF for at, step in zip(place, self.velocity, strict=True)
        ]
        return [
            away if away >> 8 < size else at
            for away, at, size in zip(there, place, shape, strict=True)
        ]


@dataclass
class ManyFollower:
    """The program's state between frames; feed frames to `step` in order.

    Attributes:
        ahead: frames from a measurement to the predicted place.
        background: learnt background, uint8; None before the first frame.
    """

    ahead: int = 1
    background: Bytes | None = None
    _tracks: list[Track] = field(default_factory=lambda: [Track() for _ in range(TRACKS)])
    _newest: int = 0
    _learns: bool = True

    def step(self, frame: Bytes) -> list[Seen]:
        """Give the objects seen in the next frame, uint8 with whole NPs, in order of the tracks."""
        picture = smooth(frame)
        if self.background is None:
            self.background = picture.copy()
        mask = self._mask(picture, self.background)
        if camera_moves(mask):
            return []
        free = [track for track in self._tracks if not track.life]
        seen = [self._follow(track, mask) for track in self._tracks if track.life]
        if free:
            self._begin(free[-1], mask)
        return [one for one in seen if one]

    def _mask(self, picture: Bytes, background: Bytes) -> Mask:
        """Give what differs from the background, which learns, without ghosts and stray pixels."""
        self._learns = not self._learns
        difference = picture.astype(np.int16) - background
        mask = np.abs(difference) >= THRESHOLD
        moves = ~mask if not self._learns else np.ones_like(mask)
        background += (np.sign(difference) * moves).astype(np.uint8)
        anywhere = np.ones_like(mask)
        peel(picture, background, mask, anywhere)
        peel(picture.T, background.T, mask.T, anywhere.T)
        return solid(mask)

    def _follow(self, track: Track, mask: Mask) -> Seen | None:
        """Take the track's object out of the mask, and give it if it is there."""
        shape = (mask.shape[0], mask.shape[1])
        within = mask & track.square(shape, REACH)
        found = grow(within & track.square(shape, SEED), within)
        mask &= ~found
        rows, cols = np.nonzero(found)
        area = len(rows)
        if area < SMALLEST:
            row, col = track.expected
            track.expected = track.ahead((row, col), 1, shape)
            track.life -= 1
            return None
        place = (int(rows.sum()) << 8) // area, (int(cols.sum()) << 8) // area
        track.measure(place)
        track.expected = track.ahead(place, 1, shape)
        track.life = COAST
        there = [
            min((at >> 8) + 1, size - 1)
            for at, size in zip(track.ahead(place, self.ahead, shape), shape, strict=True)
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
