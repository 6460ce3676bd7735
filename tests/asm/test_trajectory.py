"""asm/trajectory_*.s: bit for bit as their heads say, on clips and random scenes, and how well.

Quick runs take dozens of random scenes for each program; NPCHIP_PROFILE=thorough takes 1,000.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import Chip, Machine, RunResult, load_machine
from npchip.host.vision.motion import MOTIONS, discs
from npchip.host.vision.tracks import Track, follow_outputs, rms
from tests.oracles import trajectory_prediction as oracle
from tests.support.clips import THRESHOLDS, bundled_clips, synthetic_clip
from tests.support.profiles import THOROUGH
from tests.support.programs import chip_with

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]
    Options = dict[str, int]

ASM = Path(__file__).parents[2] / "asm"
NAMES = ("trajectory_mixed", "trajectory_nonlinear", "trajectory_robust")
CHUNK = 50 if THOROUGH else 10  # random scenes to a test, so that several processes share them
SCENES = 1_000 if THOROUGH else 30
ORACLES: dict[str, Callable[..., dict[str, list[int]]]] = {
    "trajectory_mixed": oracle.trajectory_mixed,
    "trajectory_nonlinear": oracle.trajectory_nonlinear,
    "trajectory_robust": oracle.trajectory_robust,
}


@cache
def array(np_rows: int, np_cols: int) -> Machine:
    return replace(load_machine("default"), name="other", np_rows=np_rows, np_cols=np_cols)


def chip(name: str, options: Options | None = None, machine: Machine | None = None) -> Chip:
    return chip_with(name, machine or "default", options)


def assert_exact(name: str, frames: Frames, chip: Chip, options: Options | None = None) -> None:
    """Compare a run from reset, all outputs of all frames, with the oracle."""
    chip.reset()
    result = chip.run(frames)
    assert result.status == "frames-exhausted", result.error
    values = {key.lower(): value for key, value in (options or {}).items()}
    expected = ORACLES[name](frames, **values)
    if name == "trajectory_nonlinear":
        picture = oracle.nonlinear_picture(frames, expected)
        np.testing.assert_array_equal(result.outputs["picture"], picture)
    assert set(result.outputs) - {"picture"} == set(expected)
    for output, sent in expected.items():
        assert result.outputs[output].tolist() == sent, (output, options)


def settings(name: str, seed: int) -> Options:
    """Settings of a program, another with every seed."""
    rng = np.random.default_rng(seed + 1_000_000)
    options = {"THRESHOLD": int(rng.choice(THRESHOLDS))}
    if name == "trajectory_mixed":
        options["AXIS"], options["DIRECTION"] = rng.integers(0, 2, 2).tolist()
        options["INFLECTION"] = int(rng.choice([1, 1, 3]))
    elif name == "trajectory_nonlinear":
        options["INFLECTION"] = int(rng.choice([1, 3, 8, 40, 255]))
        options["STEPS"] = int(rng.choice([1, 1, 2, 3, 10]))
    return options


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("clip", bundled_clips())
def test_real_clips(name: str, clip: str) -> None:
    assert_exact(name, bundled_clips()[clip], chip(name))


@pytest.mark.parametrize(("axis", "direction"), list(product((0, 1), (0, 1))))
def test_mixed_in_every_direction_on_the_mouse(axis: int, direction: int) -> None:
    options = {"AXIS": axis, "DIRECTION": direction}
    frames = bundled_clips()["mouse_run"]
    assert_exact("trajectory_mixed", frames, chip("trajectory_mixed", options), options)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("first", range(0, SCENES, CHUNK))
def test_random_scenes(name: str, first: int) -> None:
    for group in range(first, first + CHUNK, 5):
        options = settings(name, group // 5)
        run = chip(name, options)
        for seed in range(group, group + 5):
            assert_exact(name, synthetic_clip(seed, frames=8), run, options)


@pytest.mark.parametrize(
    ("clip", "darkest", "frames", "most"),
    [("coin_slide", 130, range(5, 11), 1), ("mouse_run", 50, range(1, 70), 7)],
)
def test_centres_lie_between_the_last_and_the_present_place(
    clip: str, darkest: int, frames: range, most: int
) -> None:
    """The objects are dark. Of the mouse, not all of the fur changes from frame to frame."""
    dark = bundled_clips()[clip] < darkest
    found = chip("trajectory_robust").run(bundled_clips()[clip]).outputs
    compared = 0
    for axis, name in ((1, "center_row"), (0, "center_col")):
        places = [np.flatnonzero(frame.any(axis=axis)) for frame in dark]
        centers = [(place[0] + place[-1]) / 2 if place.size else np.nan for place in places]
        for k in frames:
            if found["valid"][k] and not np.isnan(centers[k - 1]):
                low, high = sorted((centers[k - 1], centers[k]))
                assert low - most <= int(found[name][k]) <= high + most, (name, k)
                compared += 1
    assert compared >= 2 * (len(frames) - 1)


def test_random_settings_are_varied() -> None:
    """The quick scenes already reach every direction and both sides of the inflections."""
    seen = {tuple(settings("trajectory_mixed", s).values())[1:3] for s in range(SCENES // 5)}
    assert len(seen) >= 3
    turns = [
        oracle.trajectory_nonlinear(synthetic_clip(seed, frames=8), inflection=8)["inflection"]
        for seed in range(SCENES)
    ]
    assert {0, 1, 2, 3} == set(np.concatenate(turns).tolist())


@pytest.mark.parametrize("name", NAMES)
def test_a_larger_array(name: str) -> None:
    machine = array(16, 20)
    for seed in range(6):
        options = settings(name, seed)
        frames = synthetic_clip(seed, rows=128, cols=160, frames=8)
        assert_exact(name, frames, chip(name, options, machine), options)


@pytest.mark.parametrize("name", NAMES)
def test_no_number_wraps_on_the_largest_array(name: str) -> None:
    """Single pixels that jump between corners: displacements of 255, ten steps ahead."""
    machine = array(32, 32)
    options = {"STEPS": 10, "INFLECTION": 255} if name == "trajectory_nonlinear" else {}
    run = chip(name, options, machine)
    corners = {"n": (0, 0), "s": (255, 255), "e": (0, 255), "w": (255, 0), "c": (127, 128)}
    for way in ("nsnsss", "ssnnnn", "ewewww", "wwewee", "csnccn"):
        frames = np.zeros((2 * len(way), 256, 256), np.uint8)
        for k, corner in enumerate(way):  # appears, and disappears again: twice the same centre
            frames[2 * k + 1][corners[corner]] = 200
        assert_exact(name, frames, run, options)


@pytest.mark.parametrize("inflection", [1, 2, 127, 128, 129, 255])
@pytest.mark.parametrize("name", ["trajectory_mixed", "trajectory_nonlinear"])
def test_unusual_thresholds_of_inflections(name: str, inflection: int) -> None:
    rng = np.random.default_rng(inflection)
    frames = np.zeros((14, 64, 80), np.uint8)
    for frame in frames:
        frame[rng.integers(64), rng.integers(80)] = 255
    options = {"INFLECTION": inflection}
    assert_exact(name, frames, chip(name, options), options)


@pytest.mark.parametrize("name", NAMES)
def test_history_waits_while_nothing_moves(name: str) -> None:
    paths = [20, 22, 26, None, None, 32, 40, 50, None, 62]
    frames = np.zeros((len(paths) + 1, 64, 80), np.uint8)
    for k, col in enumerate(paths):
        frames[k + 1] = frames[k]
        if col is not None:
            frames[k + 1, 30, :] = 0
            frames[k + 1, 30, col] = 200
    assert_exact(name, frames, chip(name))
    sent = ORACLES[name](frames)
    assert sent["valid"] == [0, 1, 1, 1, 0, 0, 1, 1, 1, 0, 1]


@pytest.mark.parametrize("name", NAMES)
def test_double_sampling_removes_the_fixed_pattern(name: str) -> None:
    frames = bundled_clips()["coin_slide"][:14] // 2  # far from saturation
    machine = load_machine("default")
    noisy = replace(machine, sensor=replace(machine.sensor, fixed_pattern=40, seed=7))
    assert_exact(name, frames, chip(name, machine=noisy))


@pytest.mark.parametrize("name", NAMES)
def test_the_cycle_budget_is_reached_and_not_exceeded(name: str) -> None:
    frames = np.zeros((4, 64, 80), np.uint8)
    frames[1, 0, 0] = frames[1, 63, 63] = 255
    result = chip(name).run(frames)
    budget = chip(name).program.budget
    assert int(result.frame_cycles.max()) == budget.cycles
    assert budget.words is not None
    assert budget.words <= 512


@pytest.mark.parametrize("name", NAMES)
def test_settings_change_neither_words_nor_worst_cycles(name: str) -> None:
    frames = np.zeros((2, 64, 80), np.uint8)
    frames[1, 0, 0] = frames[1, 63, 63] = 255
    found = set()
    for seed in range(12):
        options = {**settings(name, seed), "STEPS": 1}
        if name != "trajectory_nonlinear":
            del options["STEPS"]
        run = chip(name, options)
        found.add((len(run.program.words), int(run.run(frames).frame_cycles.max())))
    assert len(found) == 1


# ---- what is seen


def test_mixed_stops_while_the_light_moves_back() -> None:
    """Figure 2.4: a light accelerates to the right, slows down and turns."""
    cols = np.array([10, 11, 14, 19, 26, 35, 43, 49, 53, 55, 54, 51, 46, 39])
    frames = np.zeros((len(cols), 64, 80), np.uint8)
    for frame, col in zip(frames, cols, strict=True):
        frame[30:35, col - 2 : col + 3] = 250
    result = chip("trajectory_mixed").run(frames)
    centers = (cols[1:] + cols[:-1]) // 2
    assert result.outputs["center_col"][1:].tolist() == centers.tolist()
    back = np.diff(centers, prepend=0) < 0
    assert result.outputs["inflection"][1:].tolist() == back.tolist()
    predicted = result.outputs["predicted_col"][1:]
    assert predicted[back].tolist() == centers[back].tolist()
    assert (predicted[1:9] > centers[1:9]).all()


def test_nonlinear_finds_a_bounce_in_the_rows_alone() -> None:
    rows = [10, 11, 14, 19, 26, 35, 46, 57, 46, 37, 30, 25]
    frames = np.zeros((len(rows), 64, 80), np.uint8)
    for k, row in enumerate(rows):
        frames[k, row, 5 + 4 * k] = 250
    sent = chip("trajectory_nonlinear").run(frames).outputs
    turns = np.flatnonzero(sent["inflection"]).tolist()
    assert turns
    assert {int(sent["inflection"][k]) for k in turns} == {1}
    for k in turns:
        assert sent["predicted_row"][k] == sent["center_row"][k]
        assert sent["predicted_col"][k] == sent["center_col"][k] + 4


def tracks(name: str, motion: str, paths: int) -> list[Track]:
    """Tracks of a light disc, run on the chip with a threshold that a clean sensor allows."""
    rng = np.random.default_rng(1)
    run = chip(name, {"THRESHOLD": 8})
    found = []
    for _ in range(paths):
        path = MOTIONS[motion](rng)
        run.reset()
        found.append(follow_outputs(path, outputs(run.run(discs(path)))))
    return found


def outputs(result: RunResult) -> dict[str, Any]:
    return {name: values for name, values in result.outputs.items() if name != "picture"}


def test_robust_predicts_within_085_pixels_up_to_an_acceleration_of_3() -> None:
    paths = 40 if THOROUGH else 8
    errors = []
    for motion in (name for name in MOTIONS if name.startswith(("linear", "|a|"))):
        errors.append([track.errors() for track in tracks("trajectory_robust", motion, paths)])
        assert rms(errors[-1]) < 0.95, motion
    assert len(errors) == 6
    assert rms([each for motion in errors for each in motion]) <= 0.85


@pytest.mark.thorough
def test_the_prediction_table_is_what_its_script_measures(tmp_path: Path) -> None:
    written = tmp_path / "prediction.md"
    command = [sys.executable, "-m", "examples.prediction_table", str(written)]
    subprocess.run(command, check=True, cwd=ASM.parent)
    document = ASM.parent / "docs" / "prediction.md"
    assert written.read_text(encoding="utf-8") == document.read_text(encoding="utf-8")


@pytest.mark.long
@pytest.mark.parametrize("script", ["chip_figures", "trajectory_figures", "trajectory_clips"])
def test_figures_are_drawn(script: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", f"examples.{script}", str(tmp_path)]
    subprocess.run(command, check=True, cwd=ASM.parent)
    drawn = {file.name for file in tmp_path.iterdir()}
    assert drawn
    assert drawn <= {file.name for file in (ASM.parent / "docs" / "figures").iterdir()}
