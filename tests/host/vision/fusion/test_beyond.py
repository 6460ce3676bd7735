"""Algorithms beyond the thesis's, against SciPy and NumPy's own least squares."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.host.vision.fusion import Rig, fit_path, locate, predict
from npchip.host.vision.fusion.experiment import SETTINGS, Experiment, rms
from npchip.host.vision.prediction import second_order
from tests.support.rigs import CHIPS, THESIS

BOTH = pytest.mark.parametrize("rig", [THESIS, CHIPS], ids=["thesis", "chip"])
STRAIGHT = Experiment.draw(SETTINGS["chip"], 30, 5)


def seen(rig: Rig, number: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points in the common view, seen with two pixels of noise in every offset."""
    rng = np.random.default_rng(3)
    ends = Experiment.draw(next(s for s in SETTINGS.values() if s.rig == rig), number, 6).truth
    one, two = (camera.project(ends[:, 7])[0] for camera in (rig.camera1, rig.camera2))
    noisy = (np.clip(s + rng.normal(0, 2, s.shape), 0, 63) for s in (one, two))
    first, second = noisy
    return first, second


@BOTH
def test_midpoint_is_the_middle_of_the_nearest_points(rig: Rig) -> None:
    one, two = seen(rig, 40)
    found = locate(rig, one, two, "midpoint")
    for k in np.flatnonzero(found.valid):
        starts = np.array([rig.camera1.position, rig.camera2.position])
        ways = [
            camera.point(pixels, 1.0) - camera.position
            for camera, pixels in ((rig.camera1, one[k]), (rig.camera2, two[k]))
        ]
        along, *_ = np.linalg.lstsq(np.stack([ways[0], -ways[1]], -1), starts[1] - starts[0], None)
        nearest = starts + along[:, None] * np.array(ways)
        np.testing.assert_allclose(found.points[k], nearest.mean(axis=0), rtol=1e-9)


@BOTH
def test_reprojection_is_what_scipy_finds(rig: Rig) -> None:
    one, two = seen(rig, 40)
    found = locate(rig, one, two, "reprojection")
    assert found.valid.sum() >= 30
    for k in np.flatnonzero(found.valid):

        def missed(point: Any, k: Any = k) -> NDArray[np.float64]:
            both = [rig.camera1.project(point)[0] - one[k], rig.camera2.project(point)[0] - two[k]]
            return np.concatenate(both)

        best = scipy.optimize.least_squares(
            missed, locate(rig, one[k], two[k]).points, xtol=1e-14, gtol=1e-14
        )
        np.testing.assert_allclose(found.points[k], best.x, atol=2e-5)


def test_each_step_costs_less_than_it_brings() -> None:
    """The order that the docs state: four offsets beat three, a path beats a point."""
    truth = STRAIGHT.truth
    errors = {
        name: rms(STRAIGHT.locate(name).points, truth)
        for name in ("vector", "midpoint", "reprojection", "keep-y", "extra-step")
    }
    assert errors["reprojection"] < errors["midpoint"] < errors["vector"] < errors["extra-step"]
    assert errors["extra-step"] < errors["keep-y"]


# ---- paths


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_a_fit_is_that_of_numpy(order: int) -> None:
    rng = np.random.default_rng(order)
    points = rng.normal(size=(2, 3, 9, 3))
    valid = rng.random((2, 3, 9)) < 0.8
    points[0, 0, 4] = np.nan
    times = np.sort(rng.uniform(-3, 3, 9))
    fit = fit_path(points, valid, order, times)
    for path in np.ndindex(2, 3):
        use = valid[path] & ~np.isnan(points[path]).any(axis=-1)
        expected = np.polynomial.polynomial.polyfit(times[use], points[path][use], order)
        np.testing.assert_allclose(fit.coefficients[path], expected, atol=1e-9)
        curve = np.polynomial.polynomial.polyval(np.array([0.0, 2.5]), expected).T
        np.testing.assert_allclose(fit.at([0.0, 2.5])[path], curve, atol=1e-9)


def test_too_few_points_give_no_path_but_no_exception() -> None:
    points = np.arange(30.0).reshape(2, 5, 3)
    points[0, 1:] = np.nan
    fit = fit_path(points, order=1)
    assert np.isnan(fit.coefficients[0]).all()
    assert np.isnan(fit.at([6])[0]).all()
    np.testing.assert_allclose(fit.at([6])[1], [[33.0, 34.0, 35.0]])
    with pytest.raises(InputError, match="NP509"):
        fit_path(points, order=4)


def test_a_line_through_a_path_beats_its_points() -> None:
    points = STRAIGHT.locate("reprojection")
    lines = fit_path(points.points, points.valid).at(np.arange(20))
    assert rms(lines, STRAIGHT.truth) < 0.4 * rms(points.points, STRAIGHT.truth)


@given(st.lists(st.tuples(*[st.integers(-99, 99)] * 3), min_size=3, max_size=9), st.integers(1, 4))
def test_prediction_by_three_is_equation_2_1(path: list[tuple[int, int, int]], steps: int) -> None:
    """In whole numbers: 3 x(k) - 3 x(k-1) + x(k-2), iterated; and the straight line by two."""
    second, first = (predict(np.array(path, float), order=order, steps=steps) for order in (2, 1))
    for k in range(len(path)):
        if k >= 2:
            newest = zip(path[k], path[k - 1], path[k - 2], strict=True)
            expected = [second_order(*each, steps) for each in newest]
            np.testing.assert_allclose(second[k], expected, atol=1e-6)
        else:
            assert np.isnan(second[k]).all()
        if k:
            line = [a + steps * (a - b) for a, b in zip(path[k], path[k - 1], strict=True)]
            np.testing.assert_allclose(first[k], line, atol=1e-8)


def test_prediction_waits_for_enough_positions() -> None:
    path = np.stack([np.arange(10.0), 2 * np.arange(10.0), 0 * np.arange(10.0)], -1)
    path[4] = np.nan
    valid = np.ones(10, bool)
    valid[7] = False
    ahead = predict(path, valid, steps=2, order=1, window=3)
    known = [k for k in range(10) if not np.isnan(ahead[k]).any()]
    assert known == [1, 2, 3, 4, 5, 6, 7, 8, 9]  # two of the newest three are enough
    np.testing.assert_allclose(ahead[known, 0], np.array(known) + 2)
    assert np.isnan(predict(path, valid, order=1)[[0, 4, 5, 7, 8]]).all()
    for wrong in ({"steps": 0}, {"order": 2, "window": 2}, {"order": 5}):
        with pytest.raises(InputError, match="NP509"):
            predict(path, **wrong)


def test_a_longer_window_predicts_better_in_noise() -> None:
    points = STRAIGHT.locate("reprojection").points
    errors = [
        rms(np.array([predict(p, window=w) for p in points])[:, 8:-1], STRAIGHT.truth[:, 9:])
        for w in (2, 5, 9)
    ]
    assert errors[0] > 1.5 * errors[1] > 1.5 * errors[2]
