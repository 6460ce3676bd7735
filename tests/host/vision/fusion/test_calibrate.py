"""Cameras that are turned, and how known points tell by how much."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip.base.errors import InputError
from npchip.host.vision.fusion import Camera, calibrate, locate
from npchip.host.vision.fusion.experiment import SETTINGS, straight_paths
from npchip.host.vision.fusion.rigfile import load_rig, rig_text

if TYPE_CHECKING:
    from pathlib import Path

RIG = SETTINGS["chip"].rig
LOOKS = ("+y", "-y", "+x", "-x")
AHEAD = {"+y": (0, 2, 0), "-y": (0, -2, 0), "+x": (2, 0, 0), "-x": (-2, 0, 0)}


def camera(looks: str, *turned: float) -> Camera:
    right, up, clockwise = turned
    return Camera(position=(0, 0, 0), looks=looks, ratio=64, turned=(right, up, clockwise))  # type: ignore[arg-type]


@pytest.mark.parametrize("looks", LOOKS)
def test_what_is_ahead_moves_against_the_turn(looks: str) -> None:
    """By 64 tan 5° = 5.6 pixels of the middle of the frame, (31.5, 39.5)."""
    by = 64 * np.tan(np.radians(5))
    for turned, place in (((5, 0, 0), (31.5, 39.5 - by)), ((0, 5, 0), (31.5 + by, 39.5))):
        np.testing.assert_allclose(camera(looks, *turned).project(AHEAD[looks])[0], place)
    above = np.add(AHEAD[looks], (0, 0, 0.5))  # 16 pixels above the middle
    pixels = camera(looks, 0, 0, 90 / 2).project(above)[0]
    np.testing.assert_allclose(pixels, (31.5 - 16 * 0.5**0.5, 39.5 - 16 * 0.5**0.5))


@pytest.mark.parametrize("looks", LOOKS)
def test_straight_and_point_undo_the_turn(looks: str) -> None:
    rng = np.random.default_rng(1)
    turned = camera(looks, 8, -5, 12)
    points = np.add(AHEAD[looks], rng.uniform(-0.4, 0.4, (30, 3)))
    pixels, depth = turned.project(points)
    np.testing.assert_allclose(turned.straight(pixels), turned.upright.project(points)[0])
    np.testing.assert_allclose(turned.bent(turned.straight(pixels)), pixels)
    np.testing.assert_allclose(turned.point(pixels, depth), points)


def test_a_camera_that_is_not_turned_changes_nothing() -> None:
    seen = np.array([[1.25, 7.5], [np.nan, np.nan]])
    assert RIG.upright == RIG
    np.testing.assert_array_equal(RIG.camera1.straight(seen), seen)


@pytest.mark.parametrize("algorithm", ["vector", "improved-2n", "reprojection"])
def test_every_algorithm_takes_turned_cameras(algorithm: str) -> None:
    real = replace(RIG, camera1=replace(RIG.camera1, turned=(3, -1, 2)))
    points = straight_paths(RIG, 20, np.random.default_rng(1))
    found, expected = (
        locate(rig, rig.camera1.project(points)[0], rig.camera2.project(points)[0], algorithm)
        for rig in (real, RIG)
    )
    inside = expected.valid & found.valid
    assert inside.mean() > 0.8
    np.testing.assert_allclose(found.points[inside], expected.points[inside], atol=1e-9)


def test_exact_pixels_give_the_angles_and_whole_ones_nearly() -> None:
    true = (1.5, -0.75, 2.0), (-1.25, 0.5, -3.0)
    real = replace(
        RIG,
        camera1=replace(RIG.camera1, turned=true[0]),
        camera2=replace(RIG.camera2, turned=true[1]),
    )
    known = straight_paths(RIG, 12, np.random.default_rng(2))[:, 0]
    exact = calibrate(RIG, known, real.camera1.project(known)[0], real.camera2.project(known)[0])
    assert exact.rig == real
    assert max(exact.after) < 0.01
    assert min(exact.before) > 1
    whole = calibrate(RIG, known, real.camera1.observe(known), real.camera2.observe(known))
    np.testing.assert_allclose(whole.rig.camera1.turned, true[0], atol=0.8)
    np.testing.assert_allclose(whole.rig.camera2.turned, true[1], atol=0.8)
    assert max(whole.after) < 0.5


def test_a_turned_rig_survives_its_file(tmp_path: Path) -> None:
    rig = replace(RIG, camera2=replace(RIG.camera2, turned=(0.5, 0.0, -1.25)))
    file = tmp_path / "rig.yaml"
    file.write_text(rig_text(rig))
    assert load_rig(file) == rig


def test_a_turn_beyond_the_limit_is_refused() -> None:
    known = straight_paths(RIG, 12, np.random.default_rng(2))[:, 0]
    pixels = RIG.camera1.project(known)[0]
    with pytest.raises(InputError, match="camera1 cannot be calibrated"):
        calibrate(RIG, known, pixels[:, ::-1] * 3, pixels)
