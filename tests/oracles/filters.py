"""Outputs of the filters in ``asm/``, by SciPy: pixels outside the frame are 0."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]


def edges(frames: Frames) -> Frames:
    """Sobel magnitude |gx| + |gy|, at most 255, of frames of shape (T, rows, columns)."""
    values = frames.astype(int)
    gx = [scipy.ndimage.sobel(value, axis=1, mode="constant") for value in values]
    gy = [scipy.ndimage.sobel(value, axis=0, mode="constant") for value in values]
    magnitude = np.abs(np.array(gx)) + np.abs(np.array(gy))
    clipped: Frames = np.minimum(magnitude, 255).astype(np.uint8)
    return clipped


def smooth(frames: Frames) -> Frames:
    """The 3 x 3 binomial mean, rounded half up, of frames of shape (T, rows, columns)."""
    weights = np.array([[1, 2, 1], [2, 4, 2], [1, 2, 1]])
    sums = [
        scipy.ndimage.correlate(value, weights, mode="constant") for value in frames.astype(int)
    ]
    means: NDArray[np.float64] = np.array(sums) / 16
    return np.floor(means + 0.5).astype(np.uint8)


def median(frames: Frames) -> Frames:
    """The 3 x 3 median of frames of shape (T, rows, columns)."""
    pictures = [scipy.ndimage.median_filter(frame, size=3, mode="constant") for frame in frames]
    return np.array(pictures, np.uint8)
