"""The algorithms of thesis 2.2 against fractions and each other; what they cost."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given

from npchip.host.vision.fusion import ALGORITHMS, Rig, Status, build_table, count, locate
from npchip.host.vision.fusion.experiment import straight_paths
from tests.oracles.fusion import exact, expected_status, slopes
from tests.support.rigs import CHIPS, SEEDS, THESIS, all_pairs, random_pixels, rigs

BOTH = pytest.mark.parametrize("rig", [THESIS, CHIPS], ids=["thesis", "chip"])
INTEGERS = [name for name, algorithm in ALGORITHMS.items() if algorithm.integers]
FLOATING = [name for name, algorithm in ALGORITHMS.items() if not algorithm.integers]


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


@pytest.mark.long
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
