"""Outputs of ``asm/frame_difference.s``: the change of every pixel since the last frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def frame_difference(frames: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """|f(t) - f(t-1)| of shape (T, rows, columns); zeros for the first frame."""
    pictures = np.zeros_like(frames)
    for index in range(1, len(frames)):
        now, before = frames[index].astype(int), frames[index - 1].astype(int)
        pictures[index] = np.abs(now - before)
    return pictures
