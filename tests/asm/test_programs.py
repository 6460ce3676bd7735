"""The programs of asm/ against independent calculations, their words and cycles against goldens."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.typing import NDArray

from npchip import Chip, Machine, RunResult, assemble, assemble_text, load_machine
from npchip.cli.main import cli
from npchip.machine import Sensor
from npchip.testing.golden import Entry, golden_path, load
from tests.oracles.frame_difference import frame_difference
from tests.oracles.trajectory import trajectory
from tests.support.clips import THRESHOLDS, bundled_clips, synthetic_clip
from tests.support.programs import assembled, chip_with

ASM = Path(__file__).parents[2] / "asm"
PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
GOLDEN_CLIPS = {"ball": "ball_fall_30000fps", "coin": "coin_slide"}
RANDOM_CLIPS = 300
CHUNK = 30  # random clips to a test, so that several processes share them

Frames = NDArray[np.uint8]


@cache
def large_machine() -> Machine:
    """16 × 20 NPs: frames of 128 × 160."""
    return replace(load_machine("default"), name="large", np_rows=16, np_cols=20)


def assert_trajectory(result: RunResult, frames: Frames, threshold: int) -> None:
    expected = trajectory(frames, threshold)
    assert list(result.outputs) == list(expected)
    for name, values in expected.items():
        assert result.outputs[name].tolist() == values, name


def test_there_are_programs() -> None:
    assert {"imaging", "frame_difference", "trajectory"} <= set(PROGRAMS)


@pytest.mark.parametrize("threshold", THRESHOLDS)
@pytest.mark.parametrize("clip", bundled_clips())
def test_trajectory_on_real_clips(clip: str, threshold: int) -> None:
    frames = bundled_clips()[clip]
    result = chip_with("trajectory", defines={"THRESHOLD": threshold}).run(frames)
    assert_trajectory(result, frames, threshold)


@pytest.mark.parametrize("threshold", THRESHOLDS)
@pytest.mark.parametrize("first", range(0, RANDOM_CLIPS, CHUNK))
def test_trajectory_on_random_clips(first: int, threshold: int) -> None:
    chip = chip_with("trajectory", defines={"THRESHOLD": threshold})
    for seed in range(first, first + CHUNK):
        frames = synthetic_clip(seed, frames=5)
        chip.reset()
        assert_trajectory(chip.run(frames), frames, threshold)


@pytest.mark.parametrize("threshold", [1, 127, 128, 129, 255])
def test_trajectory_at_unusual_thresholds(threshold: int) -> None:
    frames = np.random.default_rng(threshold).integers(0, 256, (6, 64, 80), np.uint8)
    frames[3] = frames[2]
    frames[4:, 8:, :] = frames[3, 8:, :]
    result = chip_with("trajectory", defines={"THRESHOLD": threshold}).run(frames)
    assert_trajectory(result, frames, threshold)


@pytest.mark.parametrize("name", ["trajectory", "imaging", "frame_difference"])
def test_programs_on_a_larger_array(name: str) -> None:
    small = bundled_clips()["coin_slide"][3:13]
    clips = [np.kron(small, np.ones((1, 2, 2), np.uint8))]
    clips += [synthetic_clip(seed, rows=128, cols=160) for seed in range(12)]
    for frames in clips:
        result = chip_with(name, large_machine()).run(frames)
        if name == "trajectory":
            assert_trajectory(result, frames, 32)
        elif name == "imaging":
            np.testing.assert_array_equal(result.outputs["picture"], frames)
        else:
            expected = frame_difference(frames)
            np.testing.assert_array_equal(result.outputs["difference"], expected)


def test_trajectory_on_the_largest_array_that_its_coordinates_reach() -> None:
    machine = replace(load_machine("default"), name="largest", np_rows=32, np_cols=32)
    frames = np.zeros((4, 256, 256), np.uint8)
    frames[1, 255, 250:] = 99  # sums of coordinates need the ninth bit here
    frames[3, 200:255, 0] = 99
    result = Chip(assemble(ASM / "trajectory.s", machine), machine).run(frames)
    assert_trajectory(result, frames, 32)


def sensing(**values: Any) -> Machine:
    machine = load_machine("default")
    return replace(machine, name="sensing", sensor=replace(machine.sensor, **values))


@pytest.mark.parametrize("clip", ["coin_slide", "city_night", "shapes_photo"])
def test_double_sampling_removes_the_fixed_pattern(clip: str) -> None:
    frames = bundled_clips()[clip][:20]
    machine = sensing(fixed_pattern=40, seed=7)
    picture = Chip(assembled("imaging"), machine).run(frames).outputs["picture"]
    offsets = dark_picture(machine).astype(int)
    assert offsets.max() == 40
    assert offsets.min() == 0
    saturated = frames + offsets > 255
    np.testing.assert_array_equal(picture[~saturated], frames[~saturated])
    # Where the signal is clipped, the offset that is taken away was not in it.
    np.testing.assert_array_equal(picture, np.where(saturated, 255 - offsets, frames))


def test_without_double_sampling_the_fixed_pattern_stays() -> None:
    source = (ASM / "imaging.s").read_text().replace("SUB     f, dark", "SUB     f, #0")
    assert source != (ASM / "imaging.s").read_text()
    frames = bundled_clips()["coin_slide"][:5]
    machine = sensing(fixed_pattern=40, seed=7)
    picture = Chip(assemble_text(source), machine).run(frames).outputs["picture"]
    offsets = dark_picture(machine).astype(int)
    np.testing.assert_array_equal(picture, np.minimum(frames + offsets, 255))
    assert (picture != frames).mean() > 0.9


def test_temporal_noise_passes_double_sampling() -> None:
    frames = np.full((8, 64, 80), 128, np.uint8)
    machine = sensing(noise_rms=4.0, fixed_pattern=60)
    picture = Chip(assembled("imaging"), machine).run(frames).outputs["picture"]
    offsets = dark_picture(replace(machine, sensor=replace(machine.sensor, noise_rms=0.0)))
    # Where the offset is small, the conversion of the dark pixel is clipped at 0.
    error = (picture.astype(float) - 128)[:, offsets >= 20]
    assert abs(error.mean()) < 0.1
    assert 5.4 < error.std() < 5.9  # two conversions: 4 · √2, and rounding to whole numbers


def test_noise_below_zero_becomes_zero() -> None:
    frames = np.zeros((4, 64, 80), np.uint8)
    machine = sensing(noise_rms=4.0, fixed_pattern=30)
    picture = Chip(assembled("imaging"), machine).run(frames).outputs["picture"]
    assert picture.max() < 30
    assert (picture == 0).mean() > 0.4


def dark_picture(machine: Machine) -> Frames:
    """The offsets, as a program without any light reads them."""
    source = """
        .output picture, 0, picture
        SAMPLE reset, 0
        .rept 64, pixel
        LD r0, [pixel]
        OUT 0, r0
        .endr
        HALT
    """
    picture = Chip(assemble_text(source), machine).run().setup.outputs["picture"]
    assert isinstance(picture, np.ndarray)
    return picture


# ---- words and cycles


def recorded(name: str) -> dict[str, Entry]:
    """The golden that `npchip test` compares with."""
    return load(golden_path(ASM / f"{name}.s"))


@pytest.mark.parametrize("name", PROGRAMS)
def test_expectations_and_goldens(name: str) -> None:
    """The regression of asm/ is ``npchip test asm``; one program at a time, for the processes."""
    done = CliRunner().invoke(cli, ["test", str(ASM / f"{name}.s")])
    assert done.exit_code == 0, done.output
    assert re.search(r"^[1-9]\d* passed, 0 failed$", done.output, re.MULTILINE), done.output


@pytest.mark.parametrize("name", PROGRAMS)
def test_goldens_pin_words_and_cycles_on_both_machines(name: str) -> None:
    golden = recorded(name)
    for clip, file in GOLDEN_CLIPS.items():
        for entry in (golden[clip], golden[f"{clip}@conservative"]):
            assert entry.words == len(assembled(name).words)
            assert len(entry.frames) == len(bundled_clips()[file])
            assert all(frame.cycles for frame in entry.frames)


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_head_of_a_program_is_true(name: str) -> None:
    golden = recorded(name)
    shown = []
    for entry in (golden["coin"], golden["coin@conservative"]):
        cycles = [frame.cycles or 0 for frame in entry.frames]
        low, high = min(cycles), max(cycles)
        shown.append(f"{low:,}" if low == high else f"{low:,} to {high:,}")
    head = (ASM / f"{name}.s").read_text()
    assert f"; Words     {golden['coin'].words}\n" in head
    assert f"; Cycles    {shown[0]} per frame (default), {shown[1]} (conservative)" in head


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_keeps_its_budgets(name: str) -> None:
    budget, golden = assembled(name).budget, recorded(name)
    assert budget.words == golden["coin"].words
    assert budget.cycles is not None
    default = [entry for run, entry in golden.items() if "@" not in run]
    assert budget.cycles >= max(frame.cycles or 0 for entry in default for frame in entry.frames)


def test_the_cycle_budget_of_trajectory_is_reached_and_not_exceeded() -> None:
    frames = np.zeros((2, 64, 80), np.uint8)
    frames[1, 0, 0] = frames[1, 63, 63] = 255
    result = chip_with("trajectory").run(frames)
    assert int(result.frame_cycles.max()) == assembled("trajectory").budget.cycles


def test_sensor_defaults_are_ideal() -> None:
    assert load_machine("default").sensor == Sensor(0, 0.0, 1)
