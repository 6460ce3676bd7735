"""The algorithms of thesis 2.2 against fractions, plain integers and each other."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from npchip.errors import InputError
from npchip.vision.fusion import (
    ALGORITHMS,
    CHIP,
    Q12,
    Camera,
    QFormat,
    Rig,
    Status,
    build_table,
    count,
    locate,
    needed_bits,
)
from npchip.vision.fusion.experiment import straight_paths
from tests.rigs import CHIPS, THESIS, all_pairs, rigs

BOTH = pytest.mark.parametrize("rig", [THESIS, CHIPS], ids=["thesis", "chip"])
INTEGERS = [name for name, algorithm in ALGORITHMS.items() if algorithm.integers]
FLOATING = [name for name, algorithm in ALGORITHMS.items() if not algorithm.integers]
SEEDS = st.integers(0, 2**32 - 1)


class Exact(NamedTuple):
    """Where two rays meet: coordinates, slopes, and 1 - t1·t2; None where they are parallel."""

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


def random_pixels(rig: Rig, seed: int, number: int) -> tuple[NDArray[np.float64], ...]:
    rng = np.random.default_rng(seed)
    return tuple(
        rng.integers(0, [camera.rows, camera.cols], (number, 2)).astype(np.float64)
        for camera in (rig.camera1, rig.camera2)
    )


# ---- the exact algorithms


@given(rigs(), SEEDS)
def test_vector_and_similarity_are_exact_over_random_geometry(rig: Rig, seed: int) -> None:
    one, two = random_pixels(rig, seed, 10)
    found = {name: locate(rig, one, two, name) for name in ("vector", "similarity")}
    for k, (a, b) in enumerate(zip(one.tolist(), two.tolist(), strict=True)):
        truth = exact(rig, a, b)
        status = expected_status(rig, truth)
        near = truth is not None and min(
            abs(truth.y - Fraction(rig.camera1.position[1])),
            abs(truth.x - Fraction(rig.camera2.position[0])),
        ) < Fraction(1, 10**9)
        for positions in found.values():
            mark = positions.status[k]
            if not near:  # on the pinhole itself rounding may go either way
                assert (Status.OK if mark == Status.BORDER else mark) == status
            assert np.isnan(positions.points[k]).all() == (mark > Status.BORDER)
            if truth is not None and mark <= Status.BORDER:
                steep = 1 / float(abs(1 - truth.t1 * truth.t2))
                size = 30 + max(map(abs, map(float, truth[:3])))
                error = np.abs(positions.points[k] - np.array(truth[:3], float)).max()
                assert error < 1e-13 * size * (1 + steep) * (1 + rig.camera1.cols)


@BOTH
def test_a_point_in_space_comes_back(rig: Rig) -> None:
    """Without rounding to pixels, exact algorithms give the point that was projected."""
    truth = straight_paths(rig, 20, np.random.default_rng(4))
    seen1, seen2 = (camera.project(truth)[0] for camera in (rig.camera1, rig.camera2))
    for name in ("vector", "similarity", "midpoint", "reprojection"):
        found = locate(rig, seen1, seen2, name)
        assert found.valid.all()
        np.testing.assert_allclose(found.points, truth, rtol=1e-9, atol=1e-9)


# ---- the table and what is made of it


@given(rigs(power=True), SEEDS)
def test_tables_are_off_by_what_the_docs_say(rig: Rig, seed: int) -> None:
    """The table: no more than from the middle to a corner of the cell. Improved: t1·t2 of that."""
    one, two = random_pixels(rig, seed, 10)
    found = {name: locate(rig, one, two, name) for name in ALGORITHMS}
    table = build_table(rig)
    for k, (a, b) in enumerate(zip(one.tolist(), two.tolist(), strict=True)):
        truth = exact(rig, a, b)
        cell1, cell2 = int(a[1]) // rig.cell, int(b[1]) // rig.cell
        entry = table.x[cell1, cell2], table.y[cell1, cell2]
        if truth is None or np.isnan(entry[0]):
            continue
        e = float(entry[1]) - float(truth.y)
        t1, t2 = float(truth.t1), float(truth.t2)
        tolerance = 1e-9 * (1 + abs(e)) * (1 + t1 * t1) * (1 + t2 * t2)
        for name, steps in (("keep-y", 1), ("extra-step", 2)):
            x, y, _ = found[name].points[k]
            if found[name].valid[k]:
                assert abs(y - float(truth.y) - e * (t1 * t2) ** steps) < tolerance
                assert abs(x - float(truth.x) - e * t1 * (t1 * t2) ** (steps - 1)) < tolerance
        corners = [
            exact(rig, [a[0], c1 * rig.cell - 0.5], [b[0], c2 * rig.cell - 0.5])
            for c1 in (cell1, cell1 + 1)
            for c2 in (cell2, cell2 + 1)
        ]
        known = [corner for corner in corners if corner is not None]
        sides = {(1 - corner.t1 * corner.t2) > 0 for corner in known}
        if len(known) == 4 and len(sides) == 1:  # the cell holds no parallel rays
            for value, axis in zip(entry, ("x", "y"), strict=True):
                ends = [float(getattr(corner, axis)) for corner in known]
                assert min(ends) - 1e-9 <= value <= max(ends) + 1e-9
                assert min(ends) - 1e-9 <= float(getattr(truth, axis)) <= max(ends) + 1e-9


@given(rigs(power=True), SEEDS)
def test_improved_takes_2_7_where_fdx_is_smaller_and_shifts_like_it_divides(
    rig: Rig, seed: int
) -> None:
    one, two = random_pixels(rig, seed, 10)
    divided, shifted = (locate(rig, one, two, name) for name in ("improved-fdx", "improved-2n"))
    np.testing.assert_array_equal(divided.points, shifted.points)
    table = build_table(rig)
    (x1, y1, z1), (x2, y2, _) = rig.camera1.position, rig.camera2.position
    for k in np.flatnonzero(divided.valid):
        cell1, cell2 = int(one[k, 1]) // rig.cell, int(two[k, 1]) // rig.cell
        t1, up1, t2 = map(float, slopes(rig, one[k].tolist(), two[k].tolist()))
        middle = (rig.cell - 1) / 2
        fdx, fdy = (abs(at % rig.cell - middle) for at in (one[k, 1], two[k, 1]))
        if fdx < fdy:
            y = y2 + (table.x[cell1, cell2] - x2) * t2
            x = x1 + (y - y1) * t1
        else:
            x = x1 + (table.y[cell1, cell2] - y1) * t1
            y = y2 + (x - x2) * t2
        np.testing.assert_allclose(divided.points[k], [x, y, z1 + (y - y1) * up1], rtol=1e-9)


def test_improved_dx_chooses_by_metres() -> None:
    """One pair by hand: f1 = 7.5 at 3 m is farther than f2 = 5.5 at 1.6 m."""
    one, two = all_pairs(THESIS)
    table = build_table(THESIS)
    found = {name: locate(THESIS, one, two, name).points for name in ("improved-dx", "keep-y")}
    cell1, cell2 = (seen[:, 1].astype(int) // 16 for seen in (one, two))
    f1, f2 = (np.abs(seen[:, 1] % 16 - 7.5) for seen in (one, two))
    keeps_x = f1 * table.y[cell1, cell2] < f2 * table.x[cell1, cell2]
    same = (found["improved-dx"] == found["keep-y"]).all(axis=-1)
    assert keeps_x.mean() == pytest.approx(0.5, abs=0.02)
    np.testing.assert_array_equal(same[keeps_x], False)
    np.testing.assert_array_equal(same[~keeps_x], True)


def test_a_table_entry_is_the_position_of_the_middle_of_its_cells() -> None:
    table = build_table(CHIPS)
    assert table.x.shape == table.y.shape == (10, 10)
    assert table.z.shape == (10, 10, 8)
    for cell1 in range(10):
        for cell2 in range(10):
            truth = exact(CHIPS, [8 * 6 + 3.5, 8 * cell1 + 3.5], [0, 8 * cell2 + 3.5])
            assert truth
            entry = table.x[cell1, cell2], table.y[cell1, cell2], table.z[cell1, cell2, 6]
            np.testing.assert_allclose(entry, np.array(truth[:3], float))


# ---- integers


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


# ---- marks


def test_every_mark_has_its_reason() -> None:
    """Cameras of 90 degrees that stand side by side, and pixels chosen for each mark."""
    rig = Rig(
        camera1=Camera(position=(1, 0, 0), looks="+y", ratio=8, rows=16, cols=16),
        camera2=Camera(position=(0, 1, 0), looks="+x", ratio=4, rows=16, cols=16),
        cell=8,
    )
    nan = np.nan
    cases = {
        ((7, 7), (7, 7)): Status.OK,
        ((0, 7), (7, 7)): Status.BORDER,
        ((7, 7), (15, 7)): Status.BORDER,
        ((nan, nan), (7, 7)): Status.UNSEEN,
        ((7, 7), (nan, 7)): Status.UNSEEN,
        ((nan, 7), (99, 99)): Status.UNSEEN,
        ((7, 16), (7, 7)): Status.OUTSIDE,
        ((7, 7), (-1, 7)): Status.OUTSIDE,
        ((7, 7), (7, np.inf)): Status.OUTSIDE,
        ((7, 11.5), (7, -0.5)): Status.PARALLEL,  # t1 = 1/2, t2 = 2
        ((7, 15), (7, 0)): Status.BEHIND,
    }
    one, two = (np.array([pair[n] for pair in cases]) for n in (0, 1))
    for name in ("vector", "similarity", "midpoint", "reprojection"):
        found = locate(rig, one, two, name)
        assert [Status(mark) for mark in found.status] == list(cases.values())
        assert (np.isnan(found.points).all(axis=-1) == ~found.valid).all()


@given(rigs(power=True), SEEDS)
def test_nothing_is_raised_and_no_nan_goes_without_a_mark(rig: Rig, seed: int) -> None:
    rng = np.random.default_rng(seed)
    odd = [np.nan, np.inf, -np.inf, -1, -0.5, 0, 0.5, 1e300]
    one, two = (
        np.where(rng.random((60, 2)) < 0.1, rng.choice(odd, (60, 2)), seen)
        for seen in random_pixels(rig, seed, 60)
    )
    for name, form in [(name, None) for name in ALGORITHMS] + [
        (name, form) for name in INTEGERS for form in (CHIP, QFormat(4, 6, 9))
    ]:
        found = locate(rig, one, two, name, form)
        assert (np.isfinite(found.points).all(axis=-1) == found.valid).all()
        assert (np.isnan(found.points).all(axis=-1) == ~found.valid).all()
        assert found.status.max() <= (Status.OVERFLOW if form else Status.BEHIND)


@pytest.mark.parametrize("name", ALGORITHMS)
def test_any_shape_gives_the_same(name: str) -> None:
    one, two = random_pixels(CHIPS, 7, 24)
    flat = locate(CHIPS, one, two, name)
    cube = locate(CHIPS, one.reshape(2, 3, 4, 2), two.reshape(2, 3, 4, 2), name)
    np.testing.assert_allclose(cube.points.reshape(24, 3), flat.points, rtol=1e-12)
    assert (cube.status.reshape(24) == flat.status).all()
    single = locate(CHIPS, one[3].tolist(), two[3].tolist(), name)
    np.testing.assert_allclose(single.points, flat.points[3], rtol=1e-12)
    assert single.status == flat.status[3]
    empty = locate(CHIPS, np.empty((0, 2)), np.empty((0, 2)), name)
    assert empty.points.shape == (0, 3)
    if name in INTEGERS:
        whole = locate(CHIPS, one, two, name, QFormat(12, 16, 28))
        alone = locate(CHIPS, one[3], two[3], name, QFormat(12, 16, 28))
        assert whole.raw is not None
        assert alone.raw is not None
        assert (alone.raw == whole.raw[3]).all()
        assert locate(CHIPS, np.empty((0, 2)), np.empty((0, 2)), name, CHIP).raw is not None


def test_the_arguments_are_left_alone() -> None:
    one, two = random_pixels(CHIPS, 8, 10)
    one[0] = np.nan
    before = one.copy(), two.copy()
    for name in ALGORITHMS:
        locate(CHIPS, one, two, name)
    np.testing.assert_array_equal(one, before[0])
    np.testing.assert_array_equal(two, before[1])


def test_wrong_arguments() -> None:
    good = np.zeros((4, 2))
    for bad in (np.zeros((4, 3)), np.zeros((5, 2)), np.zeros(()), [[1], [2, 3]], "ab", None):
        with pytest.raises(InputError, match="NP508"):
            locate(CHIPS, good, bad)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"no algorithm 'vectr'.*\n.*vector, similarity"):
        locate(CHIPS, good, good, "vectr")
    other = Rig(
        camera1=CHIPS.camera1,
        camera2=Camera(position=(0, 2, 0), looks="+x", ratio=65),
    )
    with pytest.raises(InputError, match=r"ratio of camera2 must be a power of two, found 65"):
        locate(other, good, good, "improved-2n")
    for name in FLOATING:
        with pytest.raises(InputError, match="floating point only"):
            locate(CHIPS, good, good, name, CHIP)


# ---- operations


def test_operations_are_those_of_the_thesis_or_fewer() -> None:
    for name, algorithm in ALGORITHMS.items():
        counted = count(name, THESIS)
        assert (counted is None) == (name in FLOATING)
        if counted and algorithm.thesis:
            multiplications, divisions, _ = algorithm.thesis
            found = counted["multiplications"], counted["divisions"]
            # The thesis counts R·(y2 - y1), which never changes, and divides once more.
            assert found == ((5, 1) if name == "vector" else (multiplications, divisions))
    extra = count("extra-step", THESIS)
    assert extra == {
        "additions": 10,
        "multiplications": 5,
        "divisions": 0,
        "shifts": 5,
        "comparisons": 0,
    }
