"""Fitting a picture to the size of the sensor."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError

Fit = Literal["crop", "resize"]
"""Methods to fit frames of another size: cut out the centre, or average areas."""

MAX_SIDE = 1 << 15
"""Longest side of a picture to resize, in pixels; it limits the sums."""

_STRIP = 64
"""Lines added up at a time: what a processor's cache holds."""


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

    Both directions are scaled independently, so the aspect ratio may change. All sums are whole
    numbers far below 2**63.
    """
    rows, cols = frame.shape
    sums = _sums(_sums(frame, size[1]).T, size[0]).T
    area = rows * cols
    averages: NDArray[np.int64] = (2 * sums + area) // (2 * area)
    return averages.astype(np.uint8, order="C")


def _sums(lines: NDArray[np.integer[Any]], target: int) -> NDArray[np.int64]:
    """Add up what each of `target` pixels covers of a line, in units of 1/target source pixels.

    Returns:
        int64, shape (lines, target): differences of the sums from the line's start to the edges.
    """
    count, source = lines.shape
    whole, part = np.divmod(np.arange(target + 1, dtype=np.int64) * source, target)
    cut = np.minimum(whole, source - 1)
    sums = np.empty((count, target), np.int64)
    running = np.zeros((min(count, _STRIP), source + 1), np.int64)
    for top in range(0, count, _STRIP):
        strip = lines[top : top + _STRIP]
        before = running[: len(strip)]
        np.cumsum(strip, axis=1, out=before[:, 1:])
        sums[top : top + _STRIP] = np.diff(target * before[:, whole] + part * strip[:, cut])
    return sums
