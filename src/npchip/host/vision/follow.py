"""Follow one moving object: the integer model of ``asm/follow.s`` and ``asm/follow_large.s``.

The background is learnt pixel by pixel (a sigma-delta filter), what differs from it is the mask,
and the connected pixels of the mask about the expected place are the object. docs/tracking.md
shows what this reaches on real video.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from npchip.host.vision.foreground import NP, Bytes, Foreground, Mask, shift

REACH: Final = 24
"""Half the side of the square in which an object may lie; its sums just fit into 16 bits."""
SMALLEST: Final = 6
"""Pixels of the smallest object."""
COAST: Final = 9
"""Frames that a track lasts beyond its last measurement, with the frame of that measurement."""
SURPRISE: Final = 4
"""Pixels from the expected place at which an object starts anew, at rest."""


class Sighting(NamedTuple):
    """The outputs of one frame, all 0 where ``valid`` is 0.

    Attributes:
        valid: 1 where the object has been measured.
        row: row of its centroid, whole pixels.
        col: column of its centroid.
        row_sub: the rest of the row, in 256ths.
        col_sub: the rest of the column.
        area: number of its pixels.
        predicted_row: row of the pixel expected ``ahead`` frames later.
        predicted_col: its column.
    """

    valid: int = 0
    row: int = 0
    col: int = 0
    row_sub: int = 0
    col_sub: int = 0
    area: int = 0
    predicted_row: int = 0
    predicted_col: int = 0


@dataclass
class Axis:
    """One coordinate of the track, in 256ths of a pixel, half a pixel less than it is.

    Smoothing shifts the picture by half a pixel; only the outputs take that back.

    Attributes:
        size: pixels of the frame along this axis.
        bits: of a place in the program, 8 of them behind the point.
        expected: place expected in the next frame.
        velocity: 256ths of a pixel a frame.
    """

    size: int
    bits: int = 16
    expected: int = 0
    velocity: int = 0

    def begin(self, np: int) -> None:
        """Expect the object in the middle of an NP; the place's fraction stays as it was."""
        self.expected = ((NP * np + 4) << 8) | (self.expected & 0xFF)

    def measure(self, total: int, area: int, *, fresh: bool) -> int:
        """Take a measurement into the velocity.

        Args:
            total: sum of the distances of the object's pixels from the edge of the square.
            area: number of these pixels.
            fresh: whether there is nothing to compare the place with.

        Returns:
            The place.
        """
        place = (((total << 8) // area) + ((self.first()) << 8)) % (1 << self.bits)
        error = signed(place - self.expected, 16)
        if fresh or not -SURPRISE << 8 <= error < SURPRISE << 8:
            self.velocity = 0
        else:
            self.velocity = signed(self.velocity + (error >> 3), 16)
        return place

    def first(self) -> int:
        """Give the first pixel of the square about the expected place."""
        return (self.expected >> 8) - REACH

    def advance(self, place: int) -> None:
        """Expect the object where its velocity takes it, or where it is if that is outside."""
        self.expected = self.ahead(place, 1)

    def ahead(self, place: int, frames: int) -> int:
        """Extrapolate a place, which stays where that would be outside the frame."""
        there = (place + signed(self.velocity * frames, 16)) % (1 << self.bits)
        return there if there >> 8 < self.size else place


@dataclass
class Follower:
    """The program's state between frames; feed frames to `step` in order.

    Attributes:
        ahead: frames between a measurement and its prediction: 1, 2, 4 or 8.
        large: as ``asm/follow_large.s``, whose places have 16 bits.
        foreground: what differs from the background.
    """

    ahead: int = 1
    large: bool = False
    foreground: Foreground = field(default_factory=Foreground)
    _life: int = 0
    _row: Axis = field(default_factory=lambda: Axis(0))
    _col: Axis = field(default_factory=lambda: Axis(0))

    def step(self, frame: Bytes) -> Sighting:
        """Give the outputs for the next frame, uint8 with whole NPs."""
        mask = self.foreground.mask(frame)
        if not self._row.size:
            bits = 24 if self.large else 16
            self._row, self._col = (Axis(size, bits) for size in frame.shape)
        if camera_moves(mask):
            self._life = 0
            return self._missed()
        if not self._life and not self._acquire(mask):
            return self._missed()
        fresh = self._life > COAST
        reach = REACH - 2 * self._life
        within = mask & self._square(REACH)
        rows, cols = np.nonzero(grow(within & self._square(reach), within))
        if len(rows) < SMALLEST:
            self._life -= 1
            return self._missed()
        found = []
        for axis, places in ((self._row, rows), (self._col, cols)):
            total = int((places - axis.first()).sum())
            place = axis.measure(total, len(rows), fresh=fresh)
            there = min((axis.ahead(place, self.ahead) >> 8) + 1, axis.size - 1)
            axis.advance(place)
            found.append((*divmod(place + 128, 256), there))
        self._life = COAST
        (row, row_sub, row_there), (col, col_sub, col_there) = found
        return Sighting(1, row, col, row_sub, col_sub, len(rows), row_there, col_there)

    def _missed(self) -> Sighting:
        """Expect the object where its velocity takes it, and give a frame without it."""
        for axis in (self._row, self._col):
            axis.advance(axis.expected)
        return Sighting()

    def _acquire(self, mask: Mask) -> bool:
        """Begin a track in the NP with most pixels of the mask; of several, the last one."""
        counts = mask.reshape(mask.shape[0] // NP, NP, -1, NP).sum((1, 3))
        most = counts.max()
        if most < SMALLEST:
            return False
        row, col = (int(index) for index in np.argwhere(counts == most)[-1])
        self._row.begin(row)
        self._col.begin(col)
        self._life = COAST + 1
        return True

    def _square(self, reach: int) -> Mask:
        """Give the square of ``2 * reach`` pixels a side about the expected place."""
        rows, cols = (
            (np.arange(axis.size) - (axis.expected >> 8) + reach) % (1 << axis.bits - 8) < 2 * reach
            for axis in (self._row, self._col)
        )
        return np.asarray(rows[:, None] & cols, np.bool_)


def camera_moves(mask: Mask) -> bool:
    """Tell whether the mask reaches into more than half of the NPs; the program rounds a little.

    An object that is followed lies in a part of the picture; where a camera moves, each edge of the
    background is in the mask. The background is not learnt anew then, or a slow pan would look
    still again.
    """
    counts = mask.reshape(mask.shape[0] // NP, NP, -1, NP).sum((1, 3))
    size, empty = counts.size, int((counts == 0).sum())
    cell = 64 if size < 1_024 else 16 if size < 4_096 else 4 if size < 16_384 else 1
    return bool(empty * cell >> 8 < size * cell >> 9)


def grow(seeds: Mask, mask: Mask) -> Mask:
    """Give the pixels of the mask that are connected with a seed, side by side."""
    while True:
        grown = seeds.copy()
        for down, right in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            grown |= shift(seeds, down, right)
        grown &= mask
        if np.array_equal(grown, seeds):
            return seeds
        seeds = grown


def signed(value: int, bits: int) -> int:
    """Give the number that these bits of a value stand for, the highest one as its sign."""
    half = 1 << (bits - 1)
    return (value + half) % (2 * half) - half
