"""Cameras and rig files of npchip.host.vision.fusion, against projection by matrices."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from npchip.base.errors import InputError
from npchip.host.vision.fusion import Camera, Rig, calibrate_ratio, distance_from_area, load_rig
from npchip.host.vision.fusion.rigfile import rig_as_data
from tests.support.rigs import CHIPS, PLACES, RIGS, THESIS, rigs

# Right, down and forward of a person who looks that way with the head up.
AXES = {
    "+y": ([1, 0, 0], [0, 0, -1], [0, 1, 0]),
    "-y": ([-1, 0, 0], [0, 0, -1], [0, -1, 0]),
    "+x": ([0, -1, 0], [0, 0, -1], [1, 0, 0]),
    "-x": ([0, 1, 0], [0, 0, -1], [-1, 0, 0]),
}


def camera(looks: Any = "+y", **settings: Any) -> Camera:
    return Camera(**{"position": (1.0, -2.0, 0.5), "looks": looks, "ratio": 48.0, **settings})


@pytest.mark.parametrize("looks", AXES)
@given(point=PLACES, place=PLACES)
def test_projection_is_that_of_a_camera_matrix(
    looks: Any, point: tuple[float, float, float], place: tuple[float, float, float]
) -> None:
    seeing = camera(looks, position=place)
    pixels, depth = seeing.project(point)
    intrinsic = np.array([[48, 0, (80 - 1) / 2], [0, 48, (64 - 1) / 2], [0, 0, 1.0]])
    col, row, scale = intrinsic @ np.array(AXES[looks]) @ (np.array(point) - place)
    assert depth == pytest.approx(scale)
    if scale > 0:
        np.testing.assert_allclose(pixels, [row / scale, col / scale], rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(seeing.point(pixels, depth), point, rtol=1e-9, atol=1e-9)
    else:
        assert np.isnan(pixels).all()
        assert np.isnan(seeing.observe(point)).all()


def test_a_pixel_is_half_open_and_its_middle_is_whole() -> None:
    seeing = camera(position=(0, 0, 0))
    edge = 40 / 48  # of the frame, seen from 1 m
    inside = [[-edge, 1, 0], [edge - 1e-6, 1, 0], [0.001, 1, 0.001]]
    np.testing.assert_array_equal(seeing.observe(inside), [[32, 0], [32, 79], [31, 40]])
    assert np.isnan(seeing.observe([[-edge - 1e-6, 1, 0], [edge, 1, 0]])).all()
    ends = [[-0.5, -0.5], [63.49, 79.49], [-0.51, 5], [63.5, 5], [5, -0.51], [5, 79.5]]
    assert seeing.inside(ends).tolist() == [True, True, False, False, False, False]
    h, v = seeing.offsets([[0.0, 0.0], [63.0, 79.0], [31.5, 39.5]])
    np.testing.assert_array_equal(h, [-39.5, 39.5, 0])
    np.testing.assert_array_equal(v, [31.5, -31.5, 0])


@pytest.mark.parametrize("looks", AXES)
def test_offsets_are_what_the_equations_need(looks: Any) -> None:
    """X = x1 + D·c1h/R and z = z1 + D·c1v/R with D = y - y1, and with x and y exchanged."""
    seeing, point = camera(looks), np.array([1.4, -2.3, 0.9])
    point[seeing.axis] = seeing.position[seeing.axis] + seeing.sign * 3
    h, v = seeing.offsets(seeing.project(point)[0])
    along = point[seeing.axis] - seeing.position[seeing.axis]
    other = 1 - seeing.axis
    assert seeing.position[other] + along * h / seeing.ratio == pytest.approx(point[other])
    assert seeing.position[2] + along * v / seeing.ratio == pytest.approx(point[2])
    np.testing.assert_allclose(seeing.pixels(h, v), seeing.project(point)[0])


def test_ratio_and_distance_from_a_known_object() -> None:
    """A rod of 0.5 m, seen from 2 m by a camera of ratio 96, is 24 pixels long."""
    assert calibrate_ratio(0.5, 2, 24) == 96
    seeing = camera(ratio=96.0)
    disc = np.pi * 0.1**2
    distances = np.array([0.7, 2.0, 9.0])
    pixels = np.pi * (0.1 * 96 / distances) ** 2
    np.testing.assert_allclose(distance_from_area(seeing, disc, pixels), distances)
    assert np.isnan(distance_from_area(seeing, disc, [0, -1])).all()
    for wrong in (0, -1, float("nan"), float("inf"), "1"):
        with pytest.raises(InputError, match=r"length.*above 0"):
            calibrate_ratio(wrong, 2, 24)  # type: ignore[arg-type]
        with pytest.raises(InputError, match=r"area.*above 0"):
            distance_from_area(seeing, wrong, 3)  # type: ignore[arg-type]


def test_one_camera_and_a_known_area_give_a_position() -> None:
    """A drawn disc: its area in pixels and the middle of them, and nothing else."""
    seeing = camera("+x", position=(0, 2, 1), ratio=64.0)
    truth = np.array([3.0, 2.4, 0.8])
    (row, col), _ = seeing.project(truth)
    rows, cols = np.mgrid[:64, :80]
    disc = (rows - row) ** 2 + (cols - col) ** 2 < (0.4 * 64 / 3) ** 2
    distance = distance_from_area(seeing, np.pi * 0.4**2, disc.sum())
    found = seeing.point([rows[disc].mean(), cols[disc].mean()], distance)
    np.testing.assert_allclose(found, truth, atol=0.03)


@pytest.mark.parametrize(
    ("ratio", "shift"),
    [(1, 0), (2, 1), (64, 6), (128.0, 7), (3, None), (96, None), (127.5, None), (0.5, None)],
)
def test_a_shift_is_a_power_of_two(ratio: float, shift: int | None) -> None:
    assert camera(ratio=ratio).shift == shift


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"ratio": 0}, "ratio: expected a number above 0"),
        ({"ratio": -3}, "ratio: .*found -3"),
        ({"ratio": float("nan")}, "ratio"),
        ({"ratio": True}, "ratio"),
        ({"ratio": "64"}, "ratio"),
        ({"looks": "north"}, r"looks: expected \+x, -x, \+y, -y, found north"),
        ({"position": (1, 2)}, "position: expected .x, y, z"),
        ({"position": (1, 2, float("inf"))}, "position"),
        ({"position": "abc"}, "position"),
        ({"position": None}, "position"),
        ({"rows": 0}, "rows: expected a whole number"),
        ({"cols": 79.5}, "cols"),
        ({"cols": 5000}, "cols"),
    ],
)
def test_a_camera_that_cannot_be(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        camera(**settings)
    assert caught.value.code == "NP503"


# ---- rigs and their files


def test_a_rig_file_is_read_as_it_says() -> None:
    assert THESIS.cell == 16
    assert THESIS.cells == (10, 10, 10)
    assert (THESIS.camera1.position, THESIS.camera1.looks) == ((4, 0, 0), "+y")
    assert (THESIS.camera2.position, THESIS.camera2.ratio) == ((0, 4, 0), 128)
    assert (CHIPS.cell, CHIPS.camera1.rows, CHIPS.camera2.cols) == (8, 64, 80)
    assert CHIPS.cells == (10, 10, 8)


def test_a_rig_file_may_calibrate_and_come_back(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    text = (
        (RIGS / "chip.yaml")
        .read_text()
        .replace("+x, ratio: 64", "+x, calibration: {length: 0.5, distance: 2, pixels: 16}")
    )
    file.write_text(text)
    assert load_rig(file) == CHIPS
    file.write_text(str(rig_as_data(THESIS)))
    assert load_rig(str(file)) == THESIS


ONE = "camera1: {position: [1, 0, 0], looks: +y, ratio: 64}\n"
TWO = "camera2: {position: [0, 1, 0], looks: +x, ratio: 64}\n"


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        ("- 1", "NP500", "expected a mapping"),
        ("camera1: {", "NP500", "rig.yaml:2"),
        ("camera1: !!python/object/new:os.system [ls]", "NP500", "rig.yaml:1"),
        (ONE, "NP502", "rig.yaml:1: a rig needs camera2"),
        (ONE + TWO + "cells: 8", "NP501", "rig.yaml:3: a rig has no cells.*did you mean 'cell'"),
        (ONE + TWO.replace("ratio", "ration"), "NP501", "rig.yaml:2: camera2 has no ration"),
        (ONE + TWO.replace(", ratio: 64", ""), "NP502", "rig.yaml:2: camera2 has neither ratio"),
        (
            ONE + TWO.replace("64", "64, calibration: {length: 1, distance: 1, pixels: 1}"),
            "NP502",
            "camera2 has both ratio and calibration",
        ),
        (ONE + TWO.replace("ratio: 64", "calibration: 3"), "NP503", "calibration: expected a map"),
        (
            ONE + TWO.replace("ratio: 64", "calibration: {length: 1, distance: 1}"),
            "NP502",
            "camera2.calibration needs pixels",
        ),
        (
            ONE + TWO.replace("ratio: 64", "calibration: {length: 0, distance: 1, pixels: 1}"),
            "NP503",
            "rig.yaml:2: camera2.calibration.length: expected a number above 0, found 0",
        ),
        (ONE + TWO.replace("64", "0"), "NP503", "rig.yaml:2: camera2.ratio: .*above 0.*found 0"),
        (ONE + TWO.replace("+x", "up"), "NP503", "rig.yaml:2: camera2.looks: expected"),
        (ONE + TWO.replace("position: [0, 1, 0], ", ""), "NP502", "camera2 needs position"),
        (ONE + "camera2: 5", "NP503", "rig.yaml:2: camera2: expected a mapping"),
        (ONE + TWO.replace("+x", "+y"), "NP504", "both cameras look along y.*right angles"),
        (ONE + TWO.replace("+x", "-y"), "NP504", "both cameras look along y"),
        (
            ONE.replace("+y", "-x") + TWO.replace("+x", "+y"),
            "NP504",
            "camera1 looks along -x.*exchange them",
        ),
        (ONE + TWO.replace("0, 1, 0", "1, 0, 0"), "NP504", "both cameras stand at .1.0, 0.0, 0.0"),
        (ONE + TWO + "cell: 7", "NP504", "rig.yaml:3: cell 7 does not divide the 80 cols"),
        (ONE + TWO + "cell: 0", "NP504", "rig.yaml:3: cell 0"),
        (ONE + TWO + "cell: eight", "NP504", "rig.yaml:3: cell eight"),
        (ONE + ONE, "NP500", "rig.yaml:2: 'camera1' is given twice"),
    ],
)
def test_rig_files_that_make_no_sense(tmp_path: Path, text: str, code: str, message: str) -> None:
    file = tmp_path / "rig.yaml"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        load_rig(file)
    assert caught.value.code == code
    assert re.search(message, f"{caught.value.message}\n{caught.value.hint}", re.DOTALL)
    assert "rig.yaml" in str(caught.value)


def test_a_rig_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read .*none.yaml: No such file"):
        load_rig(tmp_path / "none.yaml")


@given(rigs())
def test_rigs_survive_being_written(rig: Rig) -> None:
    form = rig_as_data(rig)
    cameras = [
        Camera(**{**form[key], "position": tuple(form[key]["position"])})
        for key in ("camera1", "camera2")
    ]
    assert Rig(camera1=cameras[0], camera2=cameras[1], cell=form["cell"]) == rig
