"""asm/*_large.s: what the programs of 8 bits send, and the same on arrays beyond them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import Machine, RunResult, load_machine
from npchip.assembler import AssemblyError
from tests.asm.test_trajectory import ORACLES, assert_exact, settings
from tests.oracles.tracking import tracking
from tests.oracles.trajectory import trajectory
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.profiles import THOROUGH
from tests.support.programs import assembled, chip_with

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]

SCENES = 1_000 if THOROUGH else 60
VARIANTS = tuple(ORACLES)
SIZES = [(1, 1), (1, 256), (33, 5), (64, 80)]
LARGEST = [(128, 160), (160, 128), (256, 9), (180, 256)]


@cache
def array(np_rows: int, np_cols: int) -> Machine:
    return replace(load_machine("default"), name="large", np_rows=np_rows, np_cols=np_cols)


def assert_trajectory(result: RunResult, frames: Frames) -> None:
    for name, values in trajectory(frames, 32).items():
        assert result.outputs[name].tolist() == values, name


def assert_tracking(result: RunResult, frames: Frames, threshold: int, *, dark: bool) -> None:
    expected = tracking(frames, threshold, dark=dark)
    area = result.outputs["area"] + (result.outputs["area_high"].astype(np.int64) << 16)
    assert area.tolist() == expected.pop("area")
    for name, values in expected.items():
        assert result.outputs[name].tolist() == values, name


def test_random_clips_on_the_chip() -> None:
    dark = {"DARK": 1, "THRESHOLD": 64}
    for seed in range(SCENES):
        frames = synthetic_clip(seed, frames=5)
        assert_trajectory(chip_with("trajectory_large").run(frames), frames)
        assert_tracking(chip_with("tracking_large").run(frames), frames, 128, dark=False)
        found = chip_with("tracking_large", defines=dark).run(frames)
        assert_tracking(found, frames, 64, dark=True)


@pytest.mark.parametrize("clip", ["coin_slide", "mouse_run", "ball_fall_30000fps", "city_night"])
def test_clips_as_the_programs_of_8_bits(clip: str) -> None:
    frames = bundled_clips()[clip]
    for small, large in (("trajectory", "trajectory_large"), ("tracking", "tracking_large")):
        one, other = chip_with(small).run(frames).outputs, chip_with(large).run(frames).outputs
        assert {name: one[name].tolist() for name in one} == {
            name: other[name].tolist() for name in one
        }


@pytest.mark.parametrize(
    "size", [*SIZES, *(pytest.param(s, marks=pytest.mark.long) for s in LARGEST)]
)
def test_larger_arrays(size: tuple[int, int]) -> None:
    rows, cols = (8 * number for number in size)
    corners = np.zeros((4, rows, cols), np.uint8)
    corners[1, -1, -1] = corners[2, 0, -1] = corners[3] = 255
    machine = array(*size)
    for frames in (synthetic_clip(1, rows, cols, frames=4), corners):
        assert_trajectory(chip_with("trajectory_large", machine).run(frames), frames)
        result = chip_with("tracking_large", machine).run(frames)
        assert_tracking(result, frames, 128, dark=False)


def test_the_predictions_stay_in_the_frame() -> None:
    frames = np.zeros((4, 512, 640), np.uint8)
    frames[1, 100:110, 300:310] = frames[3, 500:, 630:] = 255
    result = chip_with("trajectory_large", array(64, 80)).run(frames)
    assert_trajectory(result, frames)
    assert result.outputs["predicted_col"][3] > 255


@pytest.mark.long
@pytest.mark.parametrize("name", VARIANTS)
def test_variants_on_random_clips(name: str) -> None:
    for seed in range(0, SCENES, 4):
        options = settings(name, seed)
        chip = chip_with(f"{name}_large", "default", options)
        for scene in range(seed, seed + 4):
            assert_exact(name, synthetic_clip(scene, frames=8), chip, options)


@pytest.mark.parametrize("name", VARIANTS)
@pytest.mark.parametrize("clip", ["coin_slide", "mouse_run", "ball_fall_30000fps", "city_night"])
def test_variants_on_real_clips(name: str, clip: str) -> None:
    assert_exact(name, bundled_clips()[clip], chip_with(f"{name}_large"))


@pytest.mark.parametrize("name", VARIANTS)
@pytest.mark.parametrize(
    "size",
    [(33, 5), (5, 40), *(pytest.param(s, marks=pytest.mark.long) for s in [(64, 80), (128, 160)])],
)
def test_variants_on_larger_arrays(name: str, size: tuple[int, int]) -> None:
    """Scenes, and pixels that jump between corners, as many frames ahead as the array allows."""
    machine, (rows, cols) = array(*size), (8 * number for number in size)
    options = {**settings(name, 1), "THRESHOLD": 32}
    if name == "trajectory_nonlinear":
        options |= {"INFLECTION": 255, "STEPS": 4 if max(size) > 40 else 9}
    chip = chip_with(f"{name}_large", machine, options)
    assert_exact(name, synthetic_clip(2, rows, cols, frames=8), chip, options)
    corners = {"n": (0, 0), "s": (-1, -1), "e": (0, -1), "w": (-1, 0), "c": (rows // 2, cols // 2)}
    for way in ("nsnsss", "ewewww", "csnccn"):
        frames = np.zeros((2 * len(way), rows, cols), np.uint8)
        for index, corner in enumerate(way):  # appears, and disappears again
            frames[2 * index + 1][corners[corner]] = 200
        assert_exact(name, frames, chip, options)


def test_steps_that_could_leave_16_bits_are_refused() -> None:
    for steps, fits in ((4, True), (5, False)):
        if fits:
            assembled("trajectory_nonlinear_large", array(128, 160), {"STEPS": steps})
        else:
            with pytest.raises(AssemblyError, match="a place STEPS frames later has 16 bits"):
                assembled("trajectory_nonlinear_large", array(128, 160), {"STEPS": steps})


@pytest.mark.parametrize(
    "name", ["trajectory_large", "tracking_large", *(f"{name}_large" for name in VARIANTS)]
)
def test_the_cycle_budget_is_reached_and_not_exceeded(name: str) -> None:
    """By a box whose ends have most bits: each axis takes its cycles alone."""
    frames = np.zeros((2, 64, 80), np.uint8)
    most = {}
    for first in (0, 7, 8, 15, 31):
        for last in (31, 39, 55, 56, 63):
            frames[1] = 0
            frames[1, first, first] = frames[1, last, last] = 255
            most[first, last] = int(chip_with(name).run(frames).frame_cycles.max())
    assert max(most.values()) == most[7, 56] == assembled(name).budget.cycles
