"""Outputs of the programs of ``examples/studies``, by NumPy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Bytes = NDArray[np.uint8]

BLOCK = 8


def pyramid(frames: Bytes) -> dict[str, Bytes]:
    """Means of 2 x 2 pixels, rounded half up, as 16 planes: one for each mean of an NP.

    Args:
        frames: uint8, shape (T, rows, columns).

    Returns:
        ``mean0`` to ``mean15``, each of shape (T, rows / 8, columns / 8).
    """
    count, rows, cols = frames.shape
    sums = frames.reshape(count, rows // 2, 2, cols // 2, 2).astype(int).sum(axis=(2, 4))
    means = np.floor(sums / 4 + 0.5).astype(np.uint8)
    return {f"mean{4 * y + x}": means[:, y::4, x::4] for y in range(4) for x in range(4)}


def block_matching(frames: Bytes, reach: int = 2) -> dict[str, Bytes]:
    """Find each block of the frame before, by the smallest sum of absolute differences.

    Before the first frame all is 0, and so is what lies outside a frame. Of equal sums the first
    in the order of rows counts.

    Args:
        frames: uint8, shape (T, rows, columns).
        reach: places to try in each direction.

    Returns:
        ``down``, ``right`` (two's complement), ``low`` and ``high`` (the sum), each of shape
        (T, rows / 8, columns / 8).
    """
    count, rows, cols = frames.shape
    before = np.concatenate([np.zeros_like(frames[:1]), frames[:-1]]).astype(int)
    padded = np.pad(frames.astype(int), ((0, 0), (reach, reach), (reach, reach)))
    places = [(y, x) for y in range(2 * reach + 1) for x in range(2 * reach + 1)]
    sums = np.array(
        [
            np.abs(padded[:, y : y + rows, x : x + cols] - before)
            .reshape(count, rows // BLOCK, BLOCK, cols // BLOCK, BLOCK)
            .sum(axis=(2, 4))
            for y, x in places
        ]
    )
    moves = (np.array(places) - reach)[sums.argmin(axis=0)]  # the first of equals
    least = sums.min(axis=0)
    return {
        "down": moves[..., 0].astype(np.uint8),
        "right": moves[..., 1].astype(np.uint8),
        "low": (least & 0xFF).astype(np.uint8),
        "high": (least >> 8).astype(np.uint8),
    }
