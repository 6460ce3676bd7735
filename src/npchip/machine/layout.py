"""Conversion between frames, as a camera sees them, and planes, as the NPs hold them."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from npchip.machine.model import PIXELS

_Scalar = TypeVar("_Scalar", bound=np.generic)


def to_planes(frames: NDArray[_Scalar]) -> NDArray[_Scalar]:
    """Return frames as planes: for each pixel of an NP the values in all NPs.

    Args:
        frames: shape (..., rows, cols), usually uint8; rows and cols are multiples of 8.

    Returns:
        Shape (..., 64, NP rows, NP columns), same dtype, contiguous. Plane ``8*y + x`` holds
        pixel (y, x) of every NP, the order of an NP's memory bank.

    Raises:
        ValueError: rows or cols is not a multiple of 8.
    """
    *lead, rows, cols = frames.shape
    if rows % PIXELS or cols % PIXELS:
        raise ValueError(f"expected rows and columns in multiples of 8, found {rows} x {cols}")
    np_rows, np_cols = rows // PIXELS, cols // PIXELS
    split = frames.reshape(*lead, np_rows, PIXELS, np_cols, PIXELS)
    # (..., NP row, y, NP column, x) -> (..., y, x, NP row, NP column)
    planes = np.moveaxis(split, (-3, -1), (-4, -3))
    return np.ascontiguousarray(planes).reshape(*lead, PIXELS * PIXELS, np_rows, np_cols)


def to_frames(planes: NDArray[_Scalar]) -> NDArray[_Scalar]:
    """Return planes as frames: the inverse of `to_planes`.

    Args:
        planes: shape (..., 64, NP rows, NP columns).

    Returns:
        Shape (..., 8 * NP rows, 8 * NP columns), same dtype, contiguous.

    Raises:
        ValueError: there are not 64 planes.
    """
    *lead, count, np_rows, np_cols = planes.shape
    if count != PIXELS * PIXELS:
        raise ValueError(f"expected 64 planes, found {count}")
    split = planes.reshape(*lead, PIXELS, PIXELS, np_rows, np_cols)
    # (..., y, x, NP row, NP column) -> (..., NP row, y, NP column, x)
    frames = np.moveaxis(split, (-4, -3), (-3, -1))
    return np.ascontiguousarray(frames).reshape(*lead, PIXELS * np_rows, PIXELS * np_cols)
