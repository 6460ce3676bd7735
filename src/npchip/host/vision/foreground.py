"""Pixels that differ from a background that is learnt: the first stage of programs that follow.

The background of each pixel goes towards the picture step by step (a sigma-delta filter). What
differs from it is the mask, without ghosts, which objects have left behind, and stray pixels.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

NP: Final = 8
"""Pixels along a side of an NP."""
THRESHOLD: Final = 24
"""A pixel that differs from the background by as much belongs to the mask."""

Bytes = NDArray[np.uint8]
Mask = NDArray[np.bool_]
T = TypeVar("T", bound=np.generic)


@dataclass
class Foreground:
    """The program's state between frames; feed frames to `mask` in order.

    Attributes:
        smooths: whether a pixel is a mean of 2 x 2.
        ghosts: whether a ghost must look like its surroundings, which tells it from an object in
            its new place; otherwise an edge of the background is enough.
        background: uint8, shape (H, W), once there has been a frame.
    """

    smooths: bool = True
    ghosts: bool = True
    background: Bytes | None = None
    _means: Bytes = field(default_factory=lambda: np.zeros((1, 1), np.uint8))
    _slow: bool = True

    def mask(self, frame: Bytes) -> Mask:
        """Give the mask of the next frame, uint8 with whole NPs, and teach the background."""
        picture = smooth(frame) if self.smooths else frame
        if self.background is None:
            self.background = picture.copy()
            self._means = np.zeros((frame.shape[0] // NP, frame.shape[1] // NP), np.uint8)
        background = self.background
        self._slow = not self._slow
        difference = picture.astype(np.int16) - background
        mask = np.asarray(np.abs(difference) >= THRESHOLD, np.bool_)
        likely = mask & self._like_surroundings(picture) if self.ghosts else mask.copy()
        learn = np.where(mask & (not self._slow), 0, np.sign(difference))
        background[:] = background + learn
        sums = background.reshape(len(self._means), NP, -1, NP).sum((1, 3), dtype=np.int64)
        self._means = ((sums >> 8) + 1).astype(np.uint8)
        peel(picture, background, mask, likely)
        peel(picture.T, background.T, mask.T, likely.T)
        return solid(mask)

    def _like_surroundings(self, picture: Bytes) -> Mask:
        """Tell where surroundings lie on the picture's side of the middle to the background."""
        assert self.background is not None
        surroundings = _beside(self._means).repeat(NP, axis=0).repeat(NP, axis=1)
        middle = (picture.astype(np.uint16) + self.background) >> 2
        return np.asarray((surroundings < middle) == (picture < self.background), np.bool_)


def smooth(frame: Bytes) -> Bytes:
    """Give means of 2 x 2 pixels, each with its right, lower and diagonal neighbour.

    Noise halves, and so does the contrast of texture. Outside the frame lies 0.
    """
    wide = frame.astype(np.uint16)
    rows = np.asarray((wide + shift(wide, 0, 1)) >> 1, np.uint16)
    return np.asarray((rows + shift(rows, 1, 0)) >> 1, np.uint8)


def solid(mask: Mask) -> Mask:
    """Keep pixels with a neighbour beside them and one above or below."""
    beside = shift(mask, 0, 1) | shift(mask, 0, -1)
    return mask & beside & (shift(mask, 1, 0) | shift(mask, -1, 0))


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
    """Add up those of the two NPs beside each; one that is missing, 0, counts as its own."""
    west, east = (shift(means, 0, way) for way in (-1, 1))
    return np.asarray(np.where(west == 0, means, west) + np.where(east == 0, means, east), np.uint8)


def _distance(one: NDArray[np.generic], other: NDArray[np.generic]) -> NDArray[np.int16]:
    return np.abs(one.astype(np.int16) - other.astype(np.int16))


def shift(plane: NDArray[T], down: int, right: int) -> NDArray[T]:
    """Give what lies ``down`` and ``right`` of each element; 0 outside."""
    moved = np.zeros_like(plane)
    height, width = plane.shape
    moved[max(-down, 0) : height - max(down, 0), max(-right, 0) : width - max(right, 0)] = plane[
        max(down, 0) : height + min(down, 0), max(right, 0) : width + min(right, 0)
    ]
    return moved
