"""Outputs of ``asm/statistics.s`` in every frame, by NumPy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def statistics(frames: NDArray[np.uint8]) -> dict[str, list[Any]]:
    """Minimum, maximum, mean (rounded half up) and 16 bins, each as a low and a high byte.

    Args:
        frames: uint8, shape (T, rows, columns), of fewer than 65,536 pixels.
    """
    means = frames.astype(float).mean(axis=(1, 2))
    counts = [np.histogram(frame, bins=16, range=(0, 256))[0] for frame in frames]
    return {
        "minimum": frames.min(axis=(1, 2)).tolist(),
        "maximum": frames.max(axis=(1, 2)).tolist(),
        "mean": np.floor(means + 0.5).astype(int).tolist(),
        "histogram": [count.astype("<u2").view(np.uint8).tolist() for count in counts],
    }
