"""npchip.vision.fusion: the algorithms against exact fractions, plain integers and each other."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from npchip.vision.fusion import (
    CHIP,
    Q12,
    QFormat,
    Rig,
    build_table,
    load_rig,
    locate,
)

RIGS = Path(__file__).parents[1] / "examples" / "rigs"
THESIS, CHIPS = load_rig(RIGS / "thesis.yaml"), load_rig(RIGS / "chip.yaml")


def all_pairs(rig: Rig, row: int) -> tuple[np.ndarray, np.ndarray]:
    """Every pair of columns, in one row of camera 1."""
    col1, col2 = (
        grid.ravel()
        for grid in np.meshgrid(np.arange(rig.camera1.cols), np.arange(rig.camera2.cols))
    )
    return np.stack([0 * col1 + row, col1], -1), np.stack([0 * col2, col2], -1)


def exact(rig: Rig, seen1: list[int], seen2: list[int]) -> tuple[Fraction, ...]:
    """Intersection of two rays of the fitted rigs, from two equations solved by Cramer's rule."""
    one, two = rig.camera1, rig.camera2
    (x1, y1, z1), (x2, y2, _) = (map(Fraction, camera.position) for camera in (one, two))
    r1, r2 = Fraction(one.ratio), Fraction(two.ratio)
    right1 = Fraction(2 * seen1[1] + 1 - one.cols, 2)
    left2 = -Fraction(2 * seen2[1] + 1 - two.cols, 2)
    up1 = -Fraction(2 * seen1[0] + 1 - one.rows, 2)
    # r1 x - h1 y = r1 x1 - h1 y1;  -h2 x + r2 y = r2 y2 - h2 x2
    a, b = r1 * x1 - right1 * y1, r2 * y2 - left2 * x2
    det = r1 * r2 - right1 * left2
    x, y = (a * r2 + right1 * b) / det, (r1 * b + left2 * a) / det
    return x, y, z1 + (y - y1) * up1 / r1


@pytest.mark.parametrize("rig", [THESIS, CHIPS], ids=["thesis", "chip"])
@pytest.mark.parametrize("name", ["vector", "similarity"])
def test_exact_algorithms_are_what_fractions_say(rig: Rig, name: str) -> None:
    rng = np.random.default_rng(1)
    size = [rig.camera1.rows, rig.camera1.cols]
    one, two = (rng.integers(0, size, (200, 2)) for _ in range(2))
    found = locate(rig, one, two, name)
    expected = [
        [float(v) for v in exact(rig, a, b)]
        for a, b in zip(one.tolist(), two.tolist(), strict=True)
    ]
    np.testing.assert_allclose(found.points, expected, rtol=1e-12)


def improved_in_plain_integers(
    rig: Rig, form: QFormat, seen1: list[int], seen2: list[int]
) -> tuple[int, int, int]:
    """Equations 2.6 and 2.7 with ratio 2^n as a processor does them: add, multiply, shift."""
    one, two, f = rig.camera1, rig.camera2, form.fraction_bits
    n = int(one.ratio).bit_length() - 1
    assert 2**n == one.ratio == two.ratio
    xs, ys = build_table(rig).integers(form)
    x1, y1, z1 = (round(v * 2**f) for v in one.position)
    x2, y2, _ = (round(v * 2**f) for v in two.position)
    h1 = 2 * seen1[1] + 1 - one.cols  # in half pixels
    v1 = one.rows - 2 * seen1[0] - 1
    h2 = two.cols - 2 * seen2[1] - 1
    cell1, cell2 = seen1[1] // rig.cell, seen2[1] // rig.cell
    fdx = abs(2 * (seen1[1] - cell1 * rig.cell) + 1 - rig.cell)
    fdy = abs(2 * (seen2[1] - cell2 * rig.cell) + 1 - rig.cell)

    def times(length: int, half_pixels: int) -> int:
        return (length * half_pixels + (1 << n)) >> (n + 1)

    x, y = int(xs[cell1, cell2]), int(ys[cell1, cell2])
    if fdx < fdy:  # 2.7
        y = y2 + times(x - x2, h2)
        x = x1 + times(y - y1, h1)
    else:  # 2.6
        x = x1 + times(y - y1, h1)
        y = y2 + times(x - x2, h2)
    return x, y, z1 + times(y - y1, v1)


@pytest.mark.parametrize(("rig", "form"), [(THESIS, Q12), (CHIPS, CHIP)], ids=["thesis", "chip"])
def test_improved_2n_in_q_format_is_what_plain_integers_say(rig: Rig, form: QFormat) -> None:
    rng = np.random.default_rng(2)
    size = [rig.camera1.rows, rig.camera1.cols]
    one, two = (rng.integers(0, size, (1000, 2)) for _ in range(2))
    found = locate(rig, one, two, "improved-2n", form)
    expected = [
        improved_in_plain_integers(rig, form, a, b)
        for a, b in zip(one.tolist(), two.tolist(), strict=True)
    ]
    assert found.valid.sum() > 990
    assert found.raw is not None
    np.testing.assert_array_equal(found.raw[found.valid], np.array(expected)[found.valid])
