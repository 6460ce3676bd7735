"""Outputs of ``asm/tracking.s`` in every frame, by NumPy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

OUTPUTS = ("valid", "top", "bottom", "left", "right", "center_row", "center_col", "area")


def tracking(
    frames: NDArray[np.uint8], threshold: int, *, dark: bool = False
) -> dict[str, list[int]]:
    """Bounding box, centre and area of the pixels at or above (dark: below) the threshold.

    Args:
        frames: uint8, shape (T, rows, columns).
        threshold: least value of a pixel of a bright object.
        dark: the object is what lies below the threshold.

    Returns:
        for every name in `OUTPUTS` one number per frame.
    """
    sent: dict[str, list[int]] = {name: [] for name in OUTPUTS}
    for frame in frames:
        rows, cols = np.nonzero(frame < threshold if dark else frame >= threshold)
        values = (0,) * len(OUTPUTS)
        if len(rows):
            top, bottom, left, right = (int(n) for n in (*_ends(rows), *_ends(cols)))
            center = ((top + bottom) // 2, (left + right) // 2)
            values = (1, top, bottom, left, right, *center, len(rows))
        for name, value in zip(OUTPUTS, values, strict=True):
            sent[name].append(value)
    return sent


def _ends(numbers: NDArray[np.intp]) -> tuple[np.intp, np.intp]:
    return numbers.min(), numbers.max()
