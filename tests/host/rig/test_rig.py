"""Two chips as one camera system: positions and marks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from npchip import Chip, assemble, load_machine
from npchip.base.errors import InputError
from npchip.frames import open_frames
from npchip.host.rig import watch
from npchip.host.scenes.stereo import render_pair
from npchip.host.vision.fusion import CHIP, Status, apart, locate
from tests.host.rig.ball import RIG, RIGS, SCENE, clips

ROOT = Path(__file__).parents[3]


def whole() -> NDArray[np.bool_]:
    """Frames of the example in which no edge of a frame cuts the ball off."""
    views, inside = render_pair(SCENE, RIG), np.ones(SCENE.frames, bool)
    for view in views:
        edges = [view.centers - view.radii[:, None], view.centers + view.radii[:, None] - (63, 79)]
        inside &= (edges[0] > -0.5).all(axis=1) & (edges[1] < 0.5).all(axis=1)
    return inside


def rms(points: NDArray[np.float64]) -> float:
    """Root of the mean squared distance from where the ball was, over the frames of `whole`."""
    error = (points - SCENE.positions())[whole()]
    return float(np.sqrt((error**2).sum(axis=1).mean()))


# ---- from clips to positions


@pytest.mark.parametrize("algorithm", ["improved-2n", "extra-step"])
def test_from_two_clips_to_a_path(algorithm: str) -> None:
    seen = watch(RIG, *clips(), algorithm=algorithm)
    host = locate(RIG, seen.seen1, seen.seen2, algorithm, CHIP)
    np.testing.assert_array_equal(seen.positions.raw, host.raw)
    np.testing.assert_array_equal(seen.positions.points, host.points)
    expected = np.where(cut_off() & host.valid, Status.BORDER, host.status)
    np.testing.assert_array_equal(seen.positions.status, expected)
    assert seen.positions.status[0] == Status.UNSEEN
    assert seen.positions.valid[1:].all()
    # What is lost where each camera knows the pixel in which the ball's middle lies.
    truth = SCENE.positions()
    pixels = locate(RIG, RIG.camera1.observe(truth), RIG.camera2.observe(truth), "vector")
    bound = rms(pixels.points)
    assert 30 < whole().sum() < 39
    assert 0.018 < bound < 0.022
    if algorithm == "extra-step":
        assert rms(seen.positions.points) < 0.75 * bound  # middles of boxes come in half pixels
    else:
        assert rms(seen.positions.points) < 1.1 * bound


def cut_off() -> NDArray[np.bool_]:
    """Frames in which a bright pixel lies at an edge of a frame."""
    edges = [clip >= 128 for clip in clips()]
    sides = [(c[:, [0, -1]].any(axis=(1, 2)), c[:, :, [0, -1]].any(axis=(1, 2))) for c in edges]
    return np.asarray(np.any(sides, axis=(0, 1)))


@pytest.mark.long
def test_an_object_that_touches_an_edge_is_marked() -> None:
    """Fails before: only a middle in the outermost row or column was."""
    one, two = np.zeros((2, 5, 64, 80), np.uint8)
    one[:, 20:29, 30:39] = two[:, 20:29, 40:49] = 200
    one[1:, 20:29, 30:39] = 0
    one[1, 0:9, 30:39] = one[2, 55:64, 30:39] = one[3, 20:29, 0:9] = one[4, 20:29, 71:80] = 200
    for link in ("serial", "host"):
        seen = watch(RIG, one, two, link=link, engine="reference")
        assert seen.positions.status.tolist() == [Status.OK] + 4 * [Status.BORDER]
        assert seen.positions.valid.all()


def test_rays_that_miss_each_other_are_marked() -> None:
    """Fails before: with exchanged clips 38 of 39 positions were ok."""
    one, two = clips()
    assert not (watch(RIG, one, two).positions.status == Status.APART).any()
    seen = watch(RIG, two, one)
    assert (seen.positions.status == Status.APART).sum() > 15
    assert seen.positions.valid.sum() == 39


@given(st.integers(0, 2**32 - 1))
def test_whole_pixels_of_a_point_are_never_apart(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.uniform((0, 0.5, -1), (4, 3, 1), (50, 3))
    one, two = RIG.camera1.observe(points), RIG.camera2.observe(points)
    assert not apart(RIG, one, two).any()
    high = two + np.array([6, 0])
    meet = np.isfinite(locate(RIG, one, two).points).all(axis=1)
    assert apart(RIG, one, high)[meet].mean() > 0.9 or not meet.any()


def test_the_clips_of_the_example_are_those_of_its_scene() -> None:
    for number, clip in enumerate(clips(), 1):
        source = open_frames(RIGS / f"ball.{number}.gif", 64, 80)
        np.testing.assert_array_equal(np.stack(list(source)), clip)


def test_middles_are_those_of_the_pixels_above_the_threshold() -> None:
    seen = watch(RIG, *clips(6), link="host", threshold=77)
    for clip, found in zip(clips(6), (seen.seen1, seen.seen2), strict=True):
        for frame, (row, col) in zip(clip, found, strict=True):
            rows, cols = np.nonzero(frame >= 77)
            if rows.size:
                assert (2 * row, 2 * col) == (rows.min() + rows.max(), cols.min() + cols.max())
            else:
                assert np.isnan([row, col]).all()


@pytest.mark.long
def test_a_dark_object_is_seen_as_a_bright_one() -> None:
    one, two = clips(5)
    bright = watch(RIG, one, two, engine="reference")
    dark = watch(RIG, 255 - one, 255 - two, dark=True, engine="reference")  # 255 - 127 = 128
    np.testing.assert_array_equal(bright.positions.raw, dark.positions.raw)


@pytest.mark.long
def test_engines_agree_on_positions_and_cycles() -> None:
    one, two = clips(5)
    machine = load_machine("conservative")
    a, b = (
        watch(RIG, one, two, machine=machine, engine=engine) for engine in ("reference", "wasm")
    )
    np.testing.assert_array_equal(a.positions.raw, b.positions.raw)
    assert set(a.timings) == {"serial", "parallel", "host"}
    for name, timing in a.timings.items():
        np.testing.assert_array_equal(timing.latency, b.timings[name].latency)
        np.testing.assert_array_equal(timing.period, b.timings[name].period)


def test_a_processor_computes_every_algorithm() -> None:
    one, two = clips(4)
    for algorithm in ("vector", "reprojection"):
        seen = watch(RIG, one, two, algorithm=algorithm, link="host")
        expected = locate(RIG, seen.seen1, seen.seen2, algorithm)
        np.testing.assert_array_equal(seen.positions.points, expected.points)
        assert list(seen.timings) == ["host"]


@pytest.mark.long
def test_what_the_array_does_not_say_is_marked() -> None:
    """Rays that meet behind a camera, or too far away for a word."""
    far = replace(
        RIG,
        camera1=replace(RIG.camera1, position=(7.9, 0, 0)),
        camera2=replace(RIG.camera2, position=(0, 7.9, 0)),
    )
    clip = np.zeros((2, 64, 80), np.uint8)
    clip[0, 20, 75], clip[1, 20, 40] = 255, 255
    seen = watch(far, clip, clip[:, :, ::-1], engine="reference")
    host = locate(far, seen.seen1, seen.seen2, "improved-2n", CHIP)
    assert seen.positions.status.tolist() == host.status.tolist()
    assert seen.positions.status[0] == Status.OVERFLOW
    back = replace(RIG, camera2=replace(RIG.camera2, looks="-x"))
    seen = watch(back, clip, clip, engine="reference")
    assert set(seen.positions.status.tolist()) == {Status.BEHIND}


def test_clips_of_different_length_are_refused() -> None:
    one, two = clips(5)
    for pair in ((one, two[:4]), (iter(one[:3]), iter(two))):
        with pytest.raises(InputError) as caught:
            watch(RIG, *pair)
        assert caught.value.code == "NP520"
    assert "camera 1 has 3 frames, that of camera 2 5" in caught.value.message


@pytest.mark.parametrize(
    ("values", "code"),
    [
        ({"algorithm": "vector"}, "NP522"),
        ({"algorithm": "none", "link": "host"}, "NP505"),
        ({"machine": replace(load_machine("default"), name="x", np_cols=9)}, "NP523"),
    ],
)
def test_what_a_rig_cannot_do_is_refused(values: dict[str, Any], code: str) -> None:
    with pytest.raises(InputError) as caught:
        watch(RIG, *clips(2), **values)
    assert caught.value.code == code


@pytest.mark.long
def test_the_two_are_different_chips() -> None:
    """Noise of both cameras is that of each alone, the seed of camera 2 being the next."""
    one, two = clips(4)
    default = load_machine("default")
    sensor = replace(default.sensor, noise_rms=32, seed=2**32 - 1)
    machine = replace(default, name="x", sensor=sensor)
    seen = watch(RIG, one, two, machine=machine, threshold=60)
    host = locate(RIG, seen.seen1, seen.seen2, "improved-2n", CHIP)
    np.testing.assert_array_equal(seen.positions.raw, host.raw)
    program = assemble(ROOT / "asm" / "sighting.s", defines={"THRESHOLD": 60})
    for clip, seed, found in ((one, 2**32 - 1, seen.seen1), (two, 0, seen.seen2)):
        chip = replace(machine, sensor=replace(sensor, seed=seed))
        alone = Chip(program, chip).run(clip).outputs
        where = np.stack([alone["twice_row"], alone["twice_col"]], -1) / 2
        np.testing.assert_array_equal(found, np.where(alone["seen"][:, None], where, np.nan))


def test_a_machine_may_be_very_slow() -> None:
    slow = replace(load_machine("default"), name="slow", default_cycles=1_000_000)
    seen = watch(RIG, *clips(2), machine=slow)
    assert seen.timings["serial"].latency.min() > 500_000_000
