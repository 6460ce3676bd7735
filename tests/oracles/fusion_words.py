"""Results of `asm/fusion_lut.s`, in half pixels and for every direction."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from npchip.host.vision.fusion import Rig, Status
from tests.oracles.fusion import exact, expected_status

ONE = 1 << 12
WORD = range(-(1 << 15), 1 << 15)


class Sighting(NamedTuple):
    """First + last row and column of the object in camera 1, and column in camera 2."""

    row: int
    col: int
    other: int


def word(value: Fraction) -> int:
    """Round to 1/4096, halves up."""
    return (value * ONE + Fraction(1, 2)).__floor__()


def entry(rig: Rig, i: int, j: int) -> tuple[int, int] | None:
    """Return where the rays through cell columns i and j meet, if both cameras see that point."""
    found = exact(rig, [0, 8 * i + 3.5], [0, 8 * j + 3.5])
    if found is None or expected_status(rig, found) != Status.OK:
        return None
    return word(found.x), word(found.y)


def position(rig: Rig, seen: Sighting, rounds: int) -> tuple[int, int, int] | None:
    """Position in 1/4096 m, by the steps of thesis 2.2.4; None where a word overflows."""
    fits = True

    def times(length: int, half_pixels: int) -> int:
        nonlocal fits
        shift = int(rig.camera1.ratio).bit_length()  # one more, for half pixels
        product = (length * half_pixels + (1 << (shift - 1))) >> shift
        fits = fits and product in WORD
        return product

    (x1, y1, z1), (x2, y2, _) = (
        tuple(round(Fraction(v) * ONE) for v in camera.position)
        for camera in (rig.camera1, rig.camera2)
    )
    h1 = seen.col + 1 - rig.camera1.cols
    v1 = rig.camera1.sign * (rig.camera1.rows - 1 - seen.row)
    h2 = rig.camera2.cols - 1 - seen.other
    i, j = (seen.col + 1) // 16, (seen.other + 1) // 16
    rough = entry(rig, i, j)
    if rough is None:
        return None
    x, y = rough
    off1, off2 = abs(seen.col - 16 * i - 7), abs(seen.other - 16 * j - 7)
    if rounds == 0 and off1 < off2:
        fits = fits and x in WORD
        y = y2 + times(x - x2, h2)
        x = x1 + times(y - y1, h1)
    else:
        fits = fits and y in WORD
        for _ in range(max(rounds, 1)):
            x = x1 + times(y - y1, h1)
            y = y2 + times(x - x2, h2)
    z = z1 + times(y - y1, v1)
    return (x, y, z) if fits and all(value in WORD for value in (x, y, z)) else None
