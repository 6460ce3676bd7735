"""Rays that do not meet, odd pixels, shapes, and arguments that are refused."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from npchip.base.errors import InputError
from npchip.host.vision.fusion import ALGORITHMS, CHIP, Camera, QFormat, Rig, Status, locate
from tests.support.rigs import CHIPS, SEEDS, THESIS, random_pixels, rigs

BOTH = pytest.mark.parametrize("rig", [THESIS, CHIPS], ids=["thesis", "chip"])
INTEGERS = [name for name, algorithm in ALGORITHMS.items() if algorithm.integers]
FLOATING = [name for name, algorithm in ALGORITHMS.items() if not algorithm.integers]


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


@pytest.mark.long
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
