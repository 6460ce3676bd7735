"""Inputs of a network: edges of a frame in eight directions, counted by the NPs.

``asm/digits.s`` computes exactly this on the array; all of it is a decision. Everything is in whole
numbers.

**Cells** (`cells`). A cell is the mean of 2 x 2 pixels in 4 bits, less that of the darkest cell of
the frame: every NP has 4 x 4. With dark on bright, 15 - the mean takes its place.

**Middle** (`centred`). Cells of `INK` or more are ink. The picture moves by whole cells until the
ink's centre of mass is within half a cell of the middle of the frame; what leaves the frame is
lost, and what enters is 0.

**Counts** (`counts`). Four kernels of 3 x 3 cells take the difference of brightness across a
horizontal, a vertical and two diagonal edges. An NP counts, for each kernel, at how many of its
cells the sum is `EDGE` or more, and at how many it is -`EDGE` or less. Cells outside the frame are
0. A darker picture changes few counts.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

FRAME: Final = (64, 80)
"""Rows and columns of a frame."""

NPS: Final = (8, 10)
"""Rows and columns of NPs."""

CELLS: Final = (32, 40)
"""Rows and columns of cells."""

INK: Final = 4
"""Least value of a cell that counts as ink."""

EDGE: Final = 10
"""Least difference across an edge, in cells' values."""

KERNELS: Final = np.array(
    [
        [[-1, -1, -1], [0, 0, 0], [1, 1, 1]],
        [[-1, 0, 1], [-1, 0, 1], [-1, 0, 1]],
        [[-1, -1, 0], [-1, 0, 1], [0, 1, 1]],
        [[0, -1, -1], [1, 0, -1], [1, 1, 0]],
    ]
)
"""Brighter below, on the right, below on the right, below on the left."""

COUNTS: Final = 2 * len(KERNELS)
"""Counts of an NP: for each kernel the positive edges, then the negative ones."""

Frames = NDArray[np.uint8]
"""Shape (n, 64, 80)."""
Counts = NDArray[np.uint8]
"""Shape (n, `COUNTS`, 8, 10), 0 to 16."""


def cells(frames: Frames, *, dark: bool = False) -> NDArray[np.int64]:
    """Return the means of 2 x 2 pixels in 4 bits, less the least one of each frame.

    Args:
        frames: uint8, shape (n, 64, 80).
        dark: True for dark on bright.

    Returns:
        shape (n, 32, 40), 0 to 15.
    """
    rows, cols = CELLS
    sums = frames.reshape(-1, rows, 2, cols, 2).sum(axis=(2, 4), dtype=np.int64)
    values = 15 - (sums >> 6) if dark else sums >> 6
    return np.asarray(values - values.min(axis=(1, 2), keepdims=True))


def _moves(moment: NDArray[np.int64], mass: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return by how many cells to move back until the moment is between 0 and the mass."""
    some = np.maximum(mass, 1)
    return np.where(moment <= 0, moment // some, -(-moment // some) - 1)


def centred(values: NDArray[np.int64]) -> NDArray[np.int64]:
    """Move every picture until its ink is in the middle.

    Args:
        values: cells, shape (n, 32, 40).

    Returns:
        the same shape.
    """
    rows, cols = CELLS
    ink = values >= INK
    mass = ink.sum(axis=(1, 2), dtype=np.int64)
    down = _moves(ink.sum(axis=2) @ (np.arange(rows) - (rows // 2 - 1)), mass)
    right = _moves(ink.sum(axis=1) @ (np.arange(cols) - (cols // 2 - 1)), mass)
    padded = np.pad(values, ((0, 0), (rows, rows), (cols, cols)))
    moved = padded[
        np.arange(len(values))[:, None, None],
        rows + np.arange(rows)[:, None] + down[:, None, None],
        cols + np.arange(cols) + right[:, None, None],
    ]
    return np.asarray(moved)


def counts(frames: Frames, *, dark: bool = False) -> Counts:
    """Count the edges of every NP.

    Args:
        frames: uint8, shape (n, 64, 80).
        dark: True for dark on bright.

    Returns:
        uint8, shape (n, `COUNTS`, 8, 10).
    """
    rows, cols = CELLS
    padded = np.pad(centred(cells(frames, dark=dark)), ((0, 0), (1, 1), (1, 1)))
    found = []
    for kernel in KERNELS:
        total: NDArray[Any] = np.zeros((len(frames), rows, cols), np.int64)
        for (y, x), weight in np.ndenumerate(kernel):
            if weight:
                total += weight * padded[:, y : y + rows, x : x + cols]
        found += [total >= EDGE, total <= -EDGE]
    edges = np.stack(found, axis=1)
    blocks = edges.reshape(-1, COUNTS, NPS[0], rows // NPS[0], NPS[1], cols // NPS[1])
    return np.asarray(blocks.sum(axis=(3, 5), dtype=np.uint8))
