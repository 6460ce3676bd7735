"""Positions with marks, from arrays of pixels."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from npchip.base.errors import InputError
from npchip.host.vision.fusion.algorithms import Constants, Sight
from npchip.host.vision.fusion.arithmetic import Arithmetic, Fixed, Integers, QFormat
from npchip.host.vision.fusion.camera import Floats, Rig
from npchip.host.vision.fusion.crossing import (
    LookupTable,
    Status,
    behind,
    build_table,
    located,
    middles,
    parallel,
)
from npchip.host.vision.fusion.registry import find


@dataclass(frozen=True, eq=False)
class Positions:
    """Positions with their marks.

    Attributes:
        points: float64, shape (..., 3), metres; NaN without a position.
        status: uint8, shape (...), values of `Status`.
        raw: int64, shape (..., 3): the points in Q format, 0 without a position; None after a
            computation in floating point.
        word_bits, product_bits: longest word and product that occurred, with their sign; 0 in
            floating point.
    """

    points: Floats
    status: NDArray[np.uint8]
    raw: NDArray[np.int64] | None = None
    word_bits: int = 0
    product_bits: int = 0

    @property
    def valid(self) -> NDArray[np.bool_]:
        """Marks of positions with coordinates: bool, shape (...)."""
        return located(self.status)


def locate(
    rig: Rig,
    seen1: ArrayLike,
    seen2: ArrayLike,
    algorithm: str = "vector",
    form: QFormat | None = None,
) -> Positions:
    """Find positions by one of the algorithms of `ALGORITHMS`.

    Args:
        rig: the cameras; pixels of turned ones are straightened first.
        seen1: (..., 2), (row, column) in camera 1; NaN where it sees nothing.
        seen2: the same for camera 2.
        algorithm: name of the algorithm.
        form: word lengths of integers, for which pixels are rounded to half a pixel; None for
            floating point.

    Returns:
        the positions; those of rays that do not meet are marked.

    Raises:
        InputError: NP505, NP506 as `npchip.host.vision.fusion.registry.find`; NP507, an algorithm
            without integers; NP508, arrays of other shapes.
    """
    chosen = find(algorithm, rig)
    if form and not chosen.integers:
        raise InputError(
            "NP507",
            f"{algorithm} is computed in floating point only",
            hint="the algorithms of the thesis, keep-y and extra-step run in Q format",
        )
    one, two = pairs(seen1, seen2)
    status = seen_status(rig, one, two)
    seen = one, two
    one, two = rig.camera1.straight(one), rig.camera2.straight(two)
    rig = rig.upright
    if form:
        one, two = (np.floor(2 * seen + 0.5) / 2 for seen in (one, two))
    table = _table(rig) if chosen.table else None
    cells = _cells(rig, one, two, status) if table else None
    h1, v1 = rig.camera1.offsets(one)
    h2, v2 = rig.camera2.offsets(two)
    offsets = [np.where(status == Status.OK, value, 0) for value in (h1, v1, h2, v2)]
    if table and cells:
        _mark(status, status == Status.OK, table.status[cells[0], cells[1]])
    else:
        never = parallel(rig, offsets[0], offsets[2])
        _mark(status, status == Status.OK, Status.PARALLEL * never)
    offsets = [np.where(status == Status.OK, value, 0) for value in offsets]
    m: Any = Integers(form) if form else Arithmetic()
    sight = _sight(m, rig, offsets, table, cells)
    with np.errstate(all="ignore"):  # of elements that are marked below
        found = [m.narrow(value) for value in chosen.core(m, Constants(m, rig), sight)]
    if isinstance(m, Integers):
        return _rounded(m, rig, found, status, seen)
    return finished(rig, np.stack(np.broadcast_arrays(*found), -1), status, seen)


def pairs(seen1: ArrayLike, seen2: ArrayLike) -> tuple[Floats, Floats]:
    """Convert the pixels of both cameras to float64 of one shape.

    Raises:
        InputError: NP508.
    """
    try:
        one, two = np.asarray(seen1, np.float64), np.asarray(seen2, np.float64)
        if one.shape == two.shape and one.shape[-1:] == (2,):
            return one, two
        found = f"shapes {one.shape} and {two.shape}"
    except (TypeError, ValueError):
        found = "something else"
    raise InputError(
        "NP508",
        f"pixels of the two cameras: expected numbers of equal shape (..., 2), found {found}",
        hint="the last axis is (row, column)",
    )


def seen_status(rig: Rig, one: Floats, two: Floats) -> NDArray[np.uint8]:
    """Mark pixels as `OK`, `UNSEEN` or `OUTSIDE`: uint8, shape (...)."""
    inside = rig.camera1.inside(one) & rig.camera2.inside(two)
    unseen = np.isnan(one).any(axis=-1) | np.isnan(two).any(axis=-1)
    status = np.where(unseen, Status.UNSEEN, np.where(inside, Status.OK, Status.OUTSIDE))
    return np.asarray(status, np.uint8)


def finished(
    rig: Rig,
    points: Floats,
    status: NDArray[np.uint8],
    seen: tuple[Floats, Floats],
    *,
    raw: NDArray[np.int64] | None = None,
    bits: tuple[int, int] = (0, 0),
) -> Positions:
    """Mark points behind a camera or at a border, and clear those without a position."""
    lost = ~np.isfinite(points).all(axis=-1)
    _mark(status, (status == Status.OK) & lost, Status.PARALLEL)
    x, y = points[..., 0], points[..., 1]
    _mark(status, status == Status.OK, Status.BEHIND * behind(rig, x, y))
    border = rig.camera1.at_border(seen[0]) | rig.camera2.at_border(seen[1])
    _mark(status, status == Status.OK, Status.BORDER * border)
    valid = located(status)[..., None]
    raw = None if raw is None else np.where(valid, raw, 0)
    return Positions(np.where(valid, points, np.nan), status, raw, *bits)


@lru_cache(maxsize=64)
def needed_bits(rig: Rig, algorithm: str, fraction_bits: int = 12) -> tuple[int, int]:
    """Find the word lengths that an algorithm needs on a rig, by trying all pixels.

    Args:
        rig: the cameras.
        algorithm: name of the algorithm.
        fraction_bits: fraction bits of a word.

    Returns:
        bits of a word and of a product, with their sign, over all pairs of columns and the
        extreme rows whose rays meet in front of the cameras.

    Raises:
        InputError: as `locate`.
    """
    rows = np.array([0, rig.camera1.rows - 1])
    grids = np.meshgrid(rows, np.arange(rig.camera1.cols), np.arange(rig.camera2.cols))
    row, col1, col2 = (grid.ravel() for grid in grids)
    one, two = np.stack([row, col1], -1), np.stack([0 * row, col2], -1)
    valid = locate(rig, one, two, algorithm).valid
    wide = QFormat(fraction_bits, 32, 40)
    found = locate(rig, one[valid], two[valid], algorithm, wide)
    return found.word_bits, found.product_bits


_table = lru_cache(maxsize=8)(build_table)


def _mark(status: NDArray[np.uint8], where: NDArray[np.bool_], mark: Any) -> None:
    status[...] = np.where(where, mark, status)


def _cells(
    rig: Rig, one: Floats, two: Floats, status: NDArray[np.uint8]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return columns of cells in camera 1 and 2, and rows in camera 1; 0 where not seen."""
    n1, n2, m = rig.cells
    ok = status == Status.OK
    values = ((one[..., 1], n1), (two[..., 1], n2), (one[..., 0], m))
    first, second, row = (
        np.clip(np.floor((np.where(ok, at, 0) + 0.5) / rig.cell), 0, n - 1).astype(np.int64)
        for at, n in values
    )
    return first, second, row


def _sight(
    m: Any,
    rig: Rig,
    offsets: list[Floats],
    table: LookupTable | None,
    cells: tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]] | None,
) -> Sight:
    numbers = map(m.pixels, offsets)
    if table is None or cells is None:
        return Sight(*numbers)
    first, second, row = cells
    mid1, mid2, _ = middles(rig)
    from_middles = map(m.pixels, (offsets[0] - mid1[first], offsets[2] - mid2[second]))
    usable = table.status[first, second] == Status.OK
    entries = (table.x[first, second], table.y[first, second], table.z[first, second, row])
    words = (m.words(np.where(usable, entry, 1)) for entry in entries)
    return Sight(*numbers, *from_middles, *words)


def _rounded(
    m: Integers,
    rig: Rig,
    values: list[Fixed],
    status: NDArray[np.uint8],
    seen: tuple[Floats, Floats],
) -> Positions:
    raw = np.stack(np.broadcast_arrays(*(value.raw for value in values)), -1)
    over = np.broadcast_arrays(status, *(value.over for value in values))[1:]
    _mark(status, (status == Status.OK) & np.any(over, axis=0), Status.OVERFLOW)
    points = raw / 2.0**m.form.fraction_bits
    return finished(rig, points, status, seen, raw=raw, bits=(m.word_bits, m.product_bits))
