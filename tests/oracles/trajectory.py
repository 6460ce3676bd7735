"""Outputs of ``asm/trajectory.s`` in every frame, from the words of its contract."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

OUTPUTS = ("valid", "center_row", "center_col", "predicted_row", "predicted_col")


def trajectory(frames: NDArray[np.uint8], threshold: int) -> dict[str, list[int]]:
    """Centre of the moving pixels and linear prediction of the next centre.

    Args:
        frames: uint8, shape (T, rows, columns).
        threshold: least change of a pixel that moves.

    Returns:
        for every name in `OUTPUTS` one number per frame.
    """
    _, rows, cols = frames.shape
    sent: dict[str, list[int]] = {name: [] for name in OUTPUTS}
    centers: list[tuple[int, int]] = []  # of the valid frames so far
    for index, frame in enumerate(frames):
        moving_rows: list[int] = []
        moving_cols: list[int] = []
        if index > 0:
            difference = np.abs(frame.astype(int) - frames[index - 1].astype(int))
            where = np.nonzero(difference >= threshold)
            moving_rows, moving_cols = where[0].tolist(), where[1].tolist()
        if not moving_rows:
            values = (0, 0, 0, 0, 0)
        else:
            row = (min(moving_rows) + max(moving_rows)) // 2
            col = (min(moving_cols) + max(moving_cols)) // 2
            centers.append((row, col))
            before_row, before_col = centers[-2] if len(centers) > 1 else (row, col)
            predicted_row = min(max(2 * row - before_row, 0), rows - 1)
            predicted_col = min(max(2 * col - before_col, 0), cols - 1)
            values = (1, row, col, predicted_row, predicted_col)
        for name, value in zip(OUTPUTS, values, strict=True):
            sent[name].append(value)
    return sent
