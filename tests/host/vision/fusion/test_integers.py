"""The algorithms in Q format against plain integers; word lengths."""

from __future__ import annotations

import numpy as np
import pytest

from npchip.base.errors import InputError
from npchip.host.vision.fusion import (
    ALGORITHMS,
    CHIP,
    Q12,
    QFormat,
    Rig,
    Status,
    build_table,
    locate,
    needed_bits,
)
from npchip.host.vision.fusion.arithmetic import Integers
from tests.oracles.fusion import improved_in_plain_integers
from tests.support.rigs import CHIPS, THESIS, all_pairs, random_pixels

BOTH = pytest.mark.parametrize("rig", [THESIS, CHIPS], ids=["thesis", "chip"])
INTEGERS = [name for name, algorithm in ALGORITHMS.items() if algorithm.integers]
FLOATING = [name for name, algorithm in ALGORITHMS.items() if not algorithm.integers]


@pytest.mark.parametrize(
    ("rig", "form", "overflows"),
    [(THESIS, Q12, 0), (CHIPS, CHIP, 0), (THESIS, CHIP, 10), (CHIPS, QFormat(12, 15, 24), 50),
     (CHIPS, QFormat(12, 16, 20), 100), (CHIPS, QFormat(8, 12, 18), 0)],
)  # fmt: skip
def test_improved_2n_in_q_format_is_what_plain_integers_say(
    rig: Rig, form: QFormat, overflows: int
) -> None:
    one, two = random_pixels(rig, 2, 1000)
    found = locate(rig, one, two, "improved-2n", form)
    assert found.raw is not None
    marked = 0
    for k, (a, b) in enumerate(zip(one.astype(int), two.astype(int), strict=True)):
        expected = improved_in_plain_integers(rig, form, a.tolist(), b.tolist())
        if expected is None:
            marked += 1
            assert found.status[k] == Status.OVERFLOW
            assert np.isnan(found.points[k]).all()
            assert not found.raw[k].any()
        else:
            assert found.status[k] <= Status.BORDER
            assert tuple(found.raw[k]) == expected
            assert (found.points[k] == np.array(expected) / 2**form.fraction_bits).all()
    assert marked >= overflows
    assert (marked == 0) == (overflows == 0)


@BOTH
def test_more_fraction_bits_come_nearer_to_floating_point(rig: Rig) -> None:
    """Rounding errors shrink by about 16 with four more bits."""
    one, two = all_pairs(rig)
    for name in INTEGERS:
        if name == "improved-dx":
            continue  # where dx and dy are equal, rounding decides which is kept
        truth = locate(rig, one, two, name)
        errors = []
        for bits in (8, 12, 16):
            found = locate(rig, one, two, name, QFormat(bits, 32, 40))
            assert found.valid.all()
            if name == "lut":
                assert (np.abs(found.points - truth.points) <= 0.5 / 2**bits + 1e-12).all()
            errors.append(float(np.sqrt(np.mean((found.points - truth.points) ** 2))))
        assert errors[0] > 9 * errors[1] > 81 * errors[2], name


def test_vector_loses_by_the_quantisation_of_u() -> None:
    """U in Q12 moves y by up to half of R/4096 metres: more than half a pixel does nearby."""
    one, two = all_pairs(THESIS)
    truth = locate(THESIS, one, two).points
    for name, steps in (("vector", 128), ("similarity", 16)):
        error = np.abs(locate(THESIS, one, two, name, Q12).points - truth)[:, 1].max()
        assert error <= steps / 4096 / 2 + 1 / 4096
        if name == "vector":
            assert error > 0.9 * steps / 4096 / 2
    finer = locate(THESIS, one, two, "vector", QFormat(16, 21, 33)).points
    assert np.abs(finer - truth).max() < 128 / 2**16


@BOTH
@pytest.mark.parametrize("name", INTEGERS)
def test_needed_bits_are_enough_and_one_less_is_not(rig: Rig, name: str) -> None:
    word, product = needed_bits(rig, name)
    rows = [0, rig.camera1.rows - 1]
    for row in rows:
        one, two = all_pairs(rig, row)
        found = locate(rig, one, two, name, QFormat(12, word, max(word, product)))
        assert found.valid.all()
    one, two = (
        np.concatenate(both) for both in zip(*(all_pairs(rig, r) for r in rows), strict=True)
    )
    assert not locate(rig, one, two, name, QFormat(12, word - 1, 40)).valid.all()
    if product > word:
        assert not locate(rig, one, two, name, QFormat(12, word, product - 1)).valid.all()


def test_word_lengths_of_the_two_formats() -> None:
    """Q12 is what the fitted setting needs; the chip's words hold what runs on the chip."""
    needs = [needed_bits(THESIS, name) for name in INTEGERS]
    assert (max(n[0] for n in needs), max(n[1] for n in needs)) == (Q12.word_bits, Q12.product_bits)
    assert needed_bits(THESIS, "improved-2n") == (17, 24)
    for name in ("lut", "improved-2n", "keep-y", "extra-step"):
        word, product = needed_bits(CHIPS, name)
        assert (word, product) <= (CHIP.word_bits, CHIP.product_bits)
    with pytest.raises(InputError, match="NP507"):
        QFormat(12, 12, 24)
    with pytest.raises(InputError, match="NP507"):
        QFormat(21, 30, 40)


def test_half_pixels_count_and_finer_ones_are_rounded() -> None:
    """(first + last)/2 of a box is a multiple of a half; 7.5 lies in the second cell."""
    rng = np.random.default_rng(5)
    one, two = (rng.integers(0, [127, 159], (300, 2)) / 2 for _ in range(2))
    halves = locate(CHIPS, one, two, "improved-2n", CHIP)
    finer = locate(CHIPS, one + 0.24, two - 0.24, "improved-2n", CHIP)
    assert halves.raw is not None
    assert finer.raw is not None
    np.testing.assert_array_equal(finer.raw[finer.valid], halves.raw[finer.valid])
    exact_ones = locate(CHIPS, one, two).points
    error = np.linalg.norm(halves.points - exact_ones, axis=-1)
    whole = locate(CHIPS, np.floor(one), np.floor(two)).points
    assert np.sqrt((error**2).mean()) < 0.04 < np.linalg.norm(whole - exact_ones, axis=-1).max()
    table = build_table(CHIPS)
    entry = locate(CHIPS, [[20, 7.5]], [[20, 3.5]], "lut", CHIP)
    assert entry.points[0, 0] == pytest.approx(table.x[1, 0], abs=1 / 4096)


@pytest.mark.parametrize("bits", [9, 16])
def test_a_word_holds_what_its_length_says(bits: int) -> None:
    """The limits on both sides, of a word and of a product."""
    m = Integers(QFormat(4, bits, bits + 4))
    ends = np.array(
        [-(2 ** (bits - 1)) - 1, -(2 ** (bits - 1)), 2 ** (bits - 1) - 1, 2 ** (bits - 1)]
    )
    kept = m.words(ends / 16)
    assert kept.over.tolist() == [True, False, False, True]
    assert kept.raw.tolist() == [0, *ends[1:3].tolist(), 0]
    assert m.word_bits == bits
    most = 2 ** (bits + 3)
    sums = m.words(np.full(4, (2 ** (bits - 1) - 1) / 16)) * m.pixels([7.5, 8, 8.5, 100])
    exact_raw = (2 ** (bits - 1) - 1) * np.array([15, 16, 17, 200])
    assert sums.over.tolist() == (exact_raw >= most).tolist() == [False, False, True, True]
    zero = m.words([1.0]) / m.words([0.0])
    assert zero.over.tolist() == [True]
