"""Outputs of ``asm/correlate.s``, by SciPy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Bytes = NDArray[np.uint8]


def correlation(frames: Bytes, template: Bytes) -> dict[str, Bytes]:
    """Sum of products of every block of 8 x 8 pixels and its template, as three planes.

    Args:
        frames: uint8, shape (T, rows, columns).
        template: uint8, shape (64, rows / 8, columns / 8): 64 numbers for every block.

    Returns:
        low, middle and high byte of the sums, each of shape (T, rows / 8, columns / 8).
    """
    _, np_rows, np_cols = template.shape
    sums = np.zeros((len(frames), np_rows, np_cols), "<u4")
    for index, row, col in np.ndindex(sums.shape):
        block = frames[index, 8 * row : 8 * row + 8, 8 * col : 8 * col + 8].astype(np.int64)
        numbers = template[:, row, col].reshape(8, 8).astype(np.int64)
        sums[index, row, col] = scipy.signal.correlate(
            block, numbers, mode="valid", method="direct"
        )[0, 0]
    parts = sums.view(np.uint8).reshape(*sums.shape, 4)
    return {name: parts[..., byte] for byte, name in enumerate(("low", "middle", "high"))}
