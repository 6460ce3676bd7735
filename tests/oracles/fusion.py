"""Two cameras in fractions and in plain integers."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from npchip.host.vision.fusion import QFormat, Rig, Status


class Exact(NamedTuple):
    """The point where two rays meet: coordinates, slopes, and 1 - t1·t2; None if parallel."""

    x: Fraction
    y: Fraction
    z: Fraction
    t1: Fraction
    t2: Fraction


def slopes(rig: Rig, seen1: list[float], seen2: list[float]) -> tuple[Fraction, ...]:
    """Metres to the +x, up and +y for each metre along +y, +y and +x; from the picture alone."""
    one, two = rig.camera1, rig.camera2
    right1 = (Fraction(seen1[1]) + Fraction(1 - one.cols, 2)) / Fraction(one.ratio)
    down1 = (Fraction(seen1[0]) + Fraction(1 - one.rows, 2)) / Fraction(one.ratio)
    right2 = (Fraction(seen2[1]) + Fraction(1 - two.cols, 2)) / Fraction(two.ratio)
    if one.looks == "+y":
        t1, up1 = right1, -down1
    else:  # to its right is -x, and going along it is going along -y
        t1, up1 = right1, down1
    return t1, up1, -right2


def exact(rig: Rig, seen1: list[float], seen2: list[float]) -> Exact | None:
    """Intersect two rays by Cramer's rule in fractions."""
    (x1, y1, z1), (x2, y2, _) = (
        map(Fraction, camera.position) for camera in (rig.camera1, rig.camera2)
    )
    t1, up1, t2 = slopes(rig, seen1, seen2)
    # x - t1 y = x1 - t1 y1;  -t2 x + y = y2 - t2 x2
    a, b, det = x1 - t1 * y1, y2 - t2 * x2, 1 - t1 * t2
    if det == 0:
        return None
    x, y = (a + t1 * b) / det, (b + t2 * a) / det
    return Exact(x, y, z1 + (y - y1) * up1, t1, t2)


def expected_status(rig: Rig, found: Exact | None) -> Status:
    """The mark that exact rays deserve, borders aside."""
    if found is None:
        return Status.PARALLEL
    one, two = rig.camera1, rig.camera2
    ahead1 = (found.y - Fraction(one.position[1])) * one.sign
    ahead2 = (found.x - Fraction(two.position[0])) * two.sign
    return Status.OK if ahead1 > 0 and ahead2 > 0 else Status.BEHIND


def improved_in_plain_integers(
    rig: Rig, form: QFormat, seen1: list[int], seen2: list[int]
) -> tuple[int, int, int] | None:
    """Equations 2.6 and 2.7 with ratio 2^n as a processor does them: add, multiply, shift.

    None where a word or a product is too long.
    """
    one, two, f = rig.camera1, rig.camera2, form.fraction_bits
    n = int(one.ratio).bit_length() - 1
    assert 2**n == one.ratio == two.ratio
    x1, y1, z1 = (round(v * 2**f) for v in one.position)
    x2, y2, _ = (round(v * 2**f) for v in two.position)
    h1 = 2 * seen1[1] + 1 - one.cols  # in half pixels
    v1 = one.rows - 2 * seen1[0] - 1
    h2 = two.cols - 2 * seen2[1] - 1
    cell1, cell2 = seen1[1] // rig.cell, seen2[1] // rig.cell
    fdx = abs(2 * (seen1[1] - cell1 * rig.cell) + 1 - rig.cell)
    fdy = abs(2 * (seen2[1] - cell2 * rig.cell) + 1 - rig.cell)
    fits = True

    def kept(value: int) -> int:
        nonlocal fits
        fits = fits and -(2 ** (form.word_bits - 1)) <= value < 2 ** (form.word_bits - 1)
        return value

    def times(length: int, half_pixels: int) -> int:
        nonlocal fits
        product = length * half_pixels
        fits = fits and -(2 ** (form.product_bits - 1)) <= product < 2 ** (form.product_bits - 1)
        return kept((product + (1 << n)) >> (n + 1))

    entry = exact(
        rig,
        [0, cell1 * rig.cell + (rig.cell - 1) / 2],
        [0, cell2 * rig.cell + (rig.cell - 1) / 2],
    )
    assert entry
    x, y = (int((value * 2**f + Fraction(1, 2)) // 1) for value in entry[:2])
    if fdx < fdy:  # 2.7
        y = kept(y2 + times(kept(x) - x2, h2))
        x = kept(x1 + times(y - y1, h1))
    else:  # 2.6
        x = kept(x1 + times(kept(y) - y1, h1))
        y = kept(y2 + times(x - x2, h2))
    z = kept(z1 + times(y - y1, v1))
    return (x, y, z) if fits else None
