"""Follow one moving object: the integer model of ``asm/follow.s``, operation by operation.

The background is learnt pixel by pixel (a sigma-delta filter), what differs from it is the mask,
and the connected pixels of the mask about the expected place are the object. docs/tracking.md
shows what this reaches on real video.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

NP: Final = 8
"""Pixels along a side of an NP."""
THRESHOLD: Final = 24
"""A pixel that differs from the background by as much belongs to the mask."""
REACH: Final = 24
"""Half the side of the square in which an object may lie; its sums just fit into 16 bits."""
SMALLEST: Final = 6
"""Pixels of the smallest object."""
COAST: Final = 9
"""Frames that a track lasts beyond its last measurement, with the frame of that measurement."""
SURPRISE: Final = 4
"""Pixels from the expected place at which an object starts anew, at rest."""

Bytes = NDArray[np.uint8]
Mask = NDArray[np.bool_]
T = TypeVar("T", bound=np.generic)


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
        expected: place expected in the next frame.
        velocity: 256ths of a pixel a frame.
    """

    size: int
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
        place = (((total << 8) // area) + ((self.first()) << 8)) & 0xFFFF
        error = _signed(place - self.expected, 16)
        if fresh or not -SURPRISE << 8 <= error < SURPRISE << 8:
            self.velocity = 0
        else:
            self.velocity = _signed(self.velocity + (error >> 3), 16)
        return place

    def first(self) -> int:
        """Give the first pixel of the square about the expected place."""
        return (self.expected >> 8) - REACH

    def advance(self, place: int) -> None:
        """Expect the object where its velocity takes it, or where it is if that is outside."""
        self.expected = self.ahead(place, 1)

    def ahead(self, place: int, frames: int) -> int:
        """Extrapolate a place, which stays where that would be outside the frame."""
        there = (place + self.velocity * frames) & 0xFFFF
        return there if there >> 8 < self.size else place


@dataclass
class Follower:
    """The program's state between frames; feed frames to `step` in order.

    Attributes:
        ahead: frames between a measurement and its prediction: 1, 2, 4 or 8.
        background: uint8, shape (H, W), once there has been a frame.
    """

    ahead: int = 1
    background: Bytes | None = None
    _means: Bytes = field(default_factory=lambda: np.zeros((1, 1), np.uint8))
    _slow: bool = True
    _life: int = 0
    _row: Axis = field(default_factory=lambda: Axis(0))
    _col: Axis = field(default_factory=lambda: Axis(0))

    def step(self, frame: Bytes) -> Sighting:
        """Give the outputs for the next frame, uint8 with whole NPs."""
        picture = smooth(frame)
        if self.background is None:
            self.background = picture.copy()
            self._means = np.zeros((frame.shape[0] // NP, frame.shape[1] // NP), np.uint8)
            self._row, self._col = Axis(frame.shape[0]), Axis(frame.shape[1])
        mask = solid(self._foreground(picture, self.background))
        if camera_moves(mask):
            self._life = 0
            return Sighting()
        if not self._life and not self._acquire(mask):
            return Sighting()
        fresh = self._life > COAST
        reach = REACH - 2 * self._life
        within = mask & self._square(mask, REACH)
        rows, cols = np.nonzero(grow(within & self._square(mask, reach), within))
        if len(rows) < SMALLEST:
            self._life -= 1
            for axis in (self._row, self._col):
                axis.advance(axis.expected)
            return Sighting()
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

    def _foreground(self, picture: Bytes, background: Bytes) -> Mask:
        """Compare with the background, teach it, and give the mask without ghosts."""
        self._slow = not self._slow
        surroundings = _blocks(_beside(self._means))
        difference = picture.astype(np.int16) - background
        mask = np.abs(difference) >= THRESHOLD
        # a ghost looks more like its surroundings, which tells it from the object in its new place
        likely = mask & (_distance(picture, surroundings) < _distance(background, surroundings))
        learn = np.where(mask & (not self._slow), 0, np.sign(difference))
        background[:] = background + learn
        sums = background.reshape(len(self._means), NP, -1, NP).sum((1, 3), dtype=np.int64)
        self._means = (sums >> 6).astype(np.uint8)
        peel(picture, background, mask, likely)
        peel(picture.T, background.T, mask.T, likely.T)
        return np.asarray(mask, np.bool_)

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

    def _square(self, mask: Mask, reach: int) -> Mask:
        """Give the square of ``2 * reach`` pixels a side about the expected place."""
        rows, cols = (
            (np.arange(size) - (axis.expected >> 8) + reach) & 0xFF < 2 * reach
            for size, axis in zip(mask.shape, (self._row, self._col), strict=True)
        )
        return np.asarray(rows[:, None] & cols, np.bool_)


def smooth(frame: Bytes) -> Bytes:
    """Give means of 2 x 2 pixels, each with its right, lower and diagonal neighbour.

    Noise halves, and so does the contrast of texture. Outside the frame lies 0.
    """
    wide = frame.astype(np.uint16)
    rows = np.asarray((wide + _shift(wide, 0, 1)) >> 1, np.uint16)
    return np.asarray((rows + _shift(rows, 1, 0)) >> 1, np.uint8)


def solid(mask: Mask) -> Mask:
    """Keep pixels with a neighbour beside them and one above or below."""
    beside = _shift(mask, 0, 1) | _shift(mask, 0, -1)
    return mask & beside & (_shift(mask, 1, 0) | _shift(mask, -1, 0))


def camera_moves(mask: Mask) -> bool:
    """Tell whether the mask reaches into more than half of the NPs.

    An object that is followed lies in a part of the picture; where a camera moves, each edge of the
    background is in the mask. The background is not learnt anew then, or a slow pan would look
    still again.
    """
    counts = mask.reshape(mask.shape[0] // NP, NP, -1, NP).sum((1, 3))
    empty = int((counts == 0).sum())
    return bool(empty // 4 < counts.size // 8)


def grow(seeds: Mask, mask: Mask) -> Mask:
    """Give the pixels of the mask that are connected with a seed, side by side."""
    while True:
        grown = seeds.copy()
        for down, right in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            grown |= _shift(seeds, down, right)
        grown &= mask
        if np.array_equal(grown, seeds):
            return seeds
        seeds = grown


def peel(picture: Bytes, background: Bytes, mask: Mask, likely: Mask) -> None:
    """Take ghosts into the background, in place, from west to east.

    A ghost is what an object has left behind: the background still has its edge, the picture no
    longer. Only pixels that are ``likely`` are taken.
    """
    for x in range(NP):
        here = slice(x, None, NP)
        if x:
            before = slice(x - 1, None, NP)
            old, was, masked = picture[:, before], background[:, before], mask[:, before]
        else:
            ends = slice(NP - 1, None, NP)
            old = _from_west(picture[:, ends], 0)
            was = _from_west(background[:, ends], 0)
            masked = _from_west(mask[:, ends], 1)  # no ghost borders on what is outside
        edge = _distance(was, background[:, here]) >> 2
        border = _distance(old, picture[:, here]) < edge
        ghost = border & mask[:, here] & likely[:, here] & ~masked
        background[:, here][ghost] = picture[:, here][ghost]
        mask[:, here][ghost] = False


def _from_west(plane: NDArray[T], fill: int) -> NDArray[T]:
    moved = np.full_like(plane, fill)
    moved[:, 1:] = plane[:, :-1]
    return moved


def _beside(means: Bytes) -> Bytes:
    """Give the mean of the two NPs beside each; one that is 0 or missing counts as its own."""
    west, east = (_shift(means, 0, way).astype(np.uint16) for way in (-1, 1))
    own = means.astype(np.uint16)
    pair = np.where(west == 0, own, west) + np.where(east == 0, own, east)
    return (pair >> 1).astype(np.uint8)


def _blocks(means: Bytes) -> Bytes:
    return means.repeat(NP, axis=0).repeat(NP, axis=1)


def _distance(one: NDArray[np.generic], other: NDArray[np.generic]) -> NDArray[np.int16]:
    return np.abs(one.astype(np.int16) - other.astype(np.int16))


def _shift(plane: NDArray[T], down: int, right: int) -> NDArray[T]:
    """Give what lies ``down`` and ``right`` of each element; 0 outside."""
    moved = np.zeros_like(plane)
    height, width = plane.shape
    moved[max(-down, 0) : height - max(down, 0), max(-right, 0) : width - max(right, 0)] = plane[
        max(down, 0) : height + min(down, 0), max(right, 0) : width + min(right, 0)
    ]
    return moved


def _signed(value: int, bits: int) -> int:
    half = 1 << (bits - 1)
    return (value + half) % (2 * half) - half
