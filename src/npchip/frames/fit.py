"""Fitting a picture to the size of the sensor."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError

Fit = Literal["crop", "resize"]
"""Methods to fit frames of another size: cut out the centre, or average areas."""

MAX_SIDE = 1 << 15
"""Longest side of a picture to resize, in pixels; it limits the tables of overlaps."""

_STRIP = 256
"""Source rows scaled at a time, which limits the memory for large pictures."""


def check_fit(fit: str | None) -> None:
    """Raise InputError (NP225) unless `fit` is None, ``"crop"`` or ``"resize"``."""
    if fit not in (None, "crop", "resize"):
        raise InputError("NP225", f"fit: expected crop or resize, found {fit!r}")


def check_size(found: tuple[int, int], wanted: tuple[int, int], fit: Fit | None, name: str) -> None:
    """Raise for a size (rows, columns) that `fit` cannot change to the wanted one.

    Raises:
        InputError: NP216 a picture without pixels, NP217 another size without `fit`,
            NP218 too small to crop, NP222 a side too long to resize.
    """
    size = f"{found[0]} x {found[1]}"
    target = f"{wanted[0]} x {wanted[1]}"
    if 0 in found:
        raise InputError("NP216", f"{name}: frames of {size} hold no pixels")
    if fit == "resize" and max(found) > MAX_SIDE:
        raise InputError("NP222", f"{name}: frames of {size} have a side longer than {MAX_SIDE}")
    if found == wanted or fit == "resize":
        return
    large_enough = found[0] >= wanted[0] and found[1] >= wanted[1]
    if fit is None:
        way = "crop for their centre, or --fit resize" if large_enough else "resize"
        raise InputError(
            "NP217",
            f"{name}: expected frames of {target} (rows x columns), found {size}",
            hint=f"--fit {way} to average areas, or name a machine of that size",
        )
    if not large_enough:
        raise InputError(
            "NP218",
            f"{name}: cannot crop frames of {size} (rows x columns) to {target}",
            hint="--fit resize also enlarges",
        )


def fit_frame(
    frame: NDArray[np.uint8], size: tuple[int, int], fit: Fit | None, name: str
) -> NDArray[np.uint8]:
    """Fit one frame to a size; return a frame of that size itself.

    Args:
        frame: uint8, shape (rows, columns), of any size.
        size: wanted (rows, columns).
        fit: method for another size; None refuses it.
        name: the frame's name in messages.

    Raises:
        InputError: as `check_size`.
    """
    found = (frame.shape[0], frame.shape[1])
    check_size(found, size, fit, name)
    if found == size:
        return frame
    if fit == "crop":
        top, left = (found[0] - size[0]) // 2, (found[1] - size[1]) // 2
        return frame[top : top + size[0], left : left + size[1]]
    return _average_areas(frame, size)


def _average_areas(frame: NDArray[np.uint8], size: tuple[int, int]) -> NDArray[np.uint8]:
    """Average the source area under each target pixel, with halves rounded up.

    Both directions are scaled independently, so the aspect ratio may change. All products are
    whole numbers far below 2**53, so float64 is exact.
    """
    rows, cols = frame.shape
    across = _overlaps(cols, size[1]).T
    strips = [frame[top : top + _STRIP] @ across for top in range(0, rows, _STRIP)]
    sums = _overlaps(rows, size[0]) @ np.concatenate(strips)
    area = rows * cols
    averages: NDArray[np.int64] = (2 * sums.astype(np.int64) + area) // (2 * area)
    return averages.astype(np.uint8)


@lru_cache(maxsize=4)
def _overlaps(source: int, target: int) -> NDArray[np.float64]:
    """Return the part of each source pixel that each target pixel covers, along one line.

    Returns:
        float64, shape (target, source): whole numbers in units of 1/target source pixels. Each
        row sums to `source`.
    """
    starts = np.arange(target, dtype=np.int64)[:, None] * source
    edges = np.arange(source, dtype=np.int64)[None, :] * target
    overlap = np.minimum(starts + source, edges + target) - np.maximum(starts, edges)
    return overlap.clip(0).astype(np.float64)
