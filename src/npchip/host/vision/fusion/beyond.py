"""Algorithms more accurate than the thesis's, all decisions of this project.

`keep_y` and `extra_step` are for the chip, with one table, no division and no comparison. A host
has `midpoint` and `reprojection`, which use all four offsets, `fit_path`, which uses a whole path,
and `predict`, which looks ahead in space.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from npchip.base.errors import InputError
from npchip.host.vision.fusion.algorithms import (
    Constants,
    Point,
    Sight,
    refined,
    shifting,
    similarity,
)
from npchip.host.vision.fusion.arithmetic import Arithmetic
from npchip.host.vision.fusion.camera import Floats

_STEPS: Final = 4
"""Gauss-Newton steps; the third moves points of the fitted setting by less than a micrometre."""

_DAMPING: Final = 1e-12
"""Damping that keeps the equations solvable for points that cannot be located."""


def keep_y(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Always keep y of the table: one table, no comparison (decision)."""
    by = shifting(m, c)
    x, y = refined(c, s, s.y, by)
    return x, y, c.z1 + by[0]((y - c.y1) * s.v1)


def extra_step(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Always keep y of the table, and refine it twice (decision).

    Every step multiplies the error in y by t1·t2, which is below 1 unless the rays are nearly
    parallel.
    """
    by = shifting(m, c)
    _, y = refined(c, s, s.y, by)
    x, y = refined(c, s, y, by)
    return x, y, c.z1 + by[0]((y - c.y1) * s.v1)


def midpoint(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Find the middle of the shortest line between the rays, which is at right angles to both.

    The rays are p + a·d and q + b·e with d = (t1, 1, s1), e = (1, t2, s2).
    """
    del m
    d = s.h1 / c.ratio1, 1.0, s.v1 / c.ratio1
    e = 1.0, s.h2 / c.ratio2, s.v2 / c.ratio2
    p, q = (c.x1, c.y1, c.z1), (c.x2, c.y2, c.z2)
    between = [there - here for here, there in zip(p, q, strict=True)]
    dd, ee, de = _dot(d, d), _dot(e, e), _dot(d, e)
    dw, ew = _dot(d, between), _dot(e, between)
    det = dd * ee - de * de
    a, b = (dw * ee - de * ew) / det, (de * dw - dd * ew) / det
    x, y, z = ((p[i] + a * d[i] + q[i] + b * e[i]) / 2 for i in range(3))
    return x, y, z


def reprojection(m: Arithmetic, c: Constants, s: Sight) -> Point:
    """Find the point whose four offsets fit best by least squares (Gauss-Newton)."""
    start = np.stack(np.broadcast_arrays(*similarity(m, c, s)), -1)
    point = start
    for _ in range(_STEPS):
        point = point + _step(c, s, point)
    better = _squares(c, s, point) < _squares(c, s, start)
    x, y, z = np.moveaxis(np.where(better[..., None], point, start), -1, 0)
    return x, y, z


def _projected(c: Constants, point: Floats) -> tuple[Floats, ...]:
    """Return the four offsets of a point, and its distances along y and x."""
    x, y, z = np.moveaxis(point, -1, 0)
    one, two = (np.where(along == 0, 1, along) for along in (y - c.y1, x - c.x2))
    k1, k2 = c.ratio1 / one, c.ratio2 / two
    return (x - c.x1) * k1, (z - c.z1) * k1, (y - c.y2) * k2, (z - c.z2) * k2, one, two


def _missed(c: Constants, s: Sight, point: Floats) -> Floats:
    """Return the residuals of the offsets in pixels: shape (..., 4)."""
    h1, v1, h2, v2, _, _ = _projected(c, point)
    return np.stack([s.h1 - h1, s.v1 - v1, s.h2 - h2, s.v2 - v2], -1)


def _squares(c: Constants, s: Sight, point: Floats) -> Floats:
    return np.asarray(np.square(_missed(c, s, point)).sum(axis=-1))


def _step(c: Constants, s: Sight, point: Floats) -> Floats:
    """Solve (JᵀJ) step = Jᵀ missed."""
    h1, v1, h2, v2, one, two = _projected(c, point)
    k1, k2, none = c.ratio1 / one, c.ratio2 / two, np.zeros(h1.shape)
    rows = [
        [k1, -h1 / one, none],
        [none, -v1 / one, k1],
        [-h2 / two, k2, none],
        [-v2 / two, none, k2],
    ]
    jacobian = np.stack([np.stack(row, -1) for row in rows], -2)
    square = np.einsum("...ki,...kj->...ij", jacobian, jacobian)
    right = np.einsum("...ki,...k->...i", jacobian, _missed(c, s, point))
    damping = _DAMPING * np.trace(square, axis1=-2, axis2=-1)[..., None, None]
    return np.linalg.solve(square + damping * np.eye(3), right[..., None])[..., 0]


def _dot(a: Any, b: Any) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


# ---- a whole path


@dataclass(frozen=True, eq=False)
class PathFit:
    """A polynomial in time through the positions of a path.

    Attributes:
        coefficients: float64, shape (..., order + 1, 3): position, velocity, ... at time 0, in
            metres and metres per frame; NaN where there are too few positions.
    """

    coefficients: Floats

    def at(self, times: ArrayLike) -> Floats:
        """Return the positions at times of shape (T,): float64, shape (..., T, 3), metres."""
        powers = np.vander(np.asarray(times, np.float64), self.coefficients.shape[-2], True)
        return np.asarray(powers @ self.coefficients)


def fit_path(
    points: ArrayLike,
    valid: ArrayLike | None = None,
    order: int = 1,
    times: ArrayLike | None = None,
) -> PathFit:
    """Fit a straight line (order 1) or a parabola (order 2) through paths, by least squares.

    Args:
        points: positions in metres, shape (..., T, 3).
        valid: whether to use a point, shape (..., T); None for all that are not NaN.
        order: order of the polynomial, 0 to 3.
        times: times in frames, shape (T,); None for 0, 1, 2, ...

    Returns:
        the fit; NaN for a path with `order` points or fewer.

    Raises:
        InputError: NP509, another order.
    """
    if order not in range(4):
        raise InputError("NP509", f"order of a path: expected 0 to 3, found {order}")
    places = np.asarray(points, np.float64)
    use = _usable(places, valid)
    count = places.shape[-2]
    when = np.arange(count, dtype=np.float64) if times is None else np.asarray(times, np.float64)
    powers = np.vander(when, order + 1, True) * use[..., None]
    enough = use.sum(axis=-1) > order
    square = np.einsum("...ti,...tj->...ij", powers, powers)
    square = np.where(enough[..., None, None], square, np.eye(order + 1))
    right = np.einsum("...ti,...tj->...ij", powers, np.where(use[..., None], places, 0))
    solved = np.linalg.solve(square, right)
    return PathFit(np.where(enough[..., None, None], solved, np.nan))


def predict(
    points: ArrayLike,
    valid: ArrayLike | None = None,
    *,
    steps: int = 1,
    order: int = 1,
    window: int | None = None,
) -> Floats:
    """Predict the position of an object in space after every frame.

    With `order` 2 and a window of 3 it is equation 2.1 of the thesis in each coordinate:
    3 x(k) - 3 x(k-1) + x(k-2). Longer windows smooth the rounding to pixels.

    Args:
        points: positions in metres, shape (T, 3).
        valid: whether to use a point, shape (T,); None for all that are not NaN.
        steps: frames ahead, at least 1.
        order: order of the polynomial through the window, 0 to 3.
        window: number of the newest frames to use; None for order + 1.

    Returns:
        float64, shape (T, 3): row k is the prediction for frame k + steps; NaN if the window has
        too few positions.

    Raises:
        InputError: NP509, steps below 1, another order, or a window that is too short for it.
    """
    window = order + 1 if window is None else window
    if steps < 1 or window <= order:
        raise InputError(
            "NP509",
            f"prediction of {steps} steps by order {order} over {window} frames: expected at least"
            f" 1 step and {order + 1} frames",
        )
    places = np.asarray(points, np.float64)
    use = np.pad(_usable(places, valid), (window - 1, 0))
    frames = np.pad(places, ((window - 1, 0), (0, 0)), constant_values=np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(frames, window, axis=0).swapaxes(-1, -2)
    used = np.lib.stride_tricks.sliding_window_view(use, window)
    fit = fit_path(windows, used, order, times=np.arange(1.0 - window, 1))
    return fit.at([steps])[..., 0, :]


def _usable(points: Floats, valid: ArrayLike | None) -> NDArray[np.bool_]:
    known = np.asarray(~np.isnan(points).any(axis=-1))
    return known if valid is None else known & np.asarray(valid, bool)
