"""The sweeps of examples/sweeps make sense, and the pages have what they measure."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from examples.measure import ROOT
from npchip.sweep import load

pytest.importorskip("pandas")
pytest.importorskip("matplotlib")

from examples import orientation_page, robustness_page, sweep_figures
from examples.measure import spread
from examples.sweeps import predictors, robustness, training, triangulation
from npchip import load_machine
from npchip.host.vision.fusion.experiment import SETTINGS, Experiment
from npchip.host.vision.tracks import error_table
from npchip.sweep.work import _function
from tests.support.profiles import THOROUGH

FILES = sorted(
    path
    for path in (ROOT / "examples" / "sweeps").glob("*.yaml")
    if not path.stem.startswith("circling")
)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_file_makes_sense(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [*sys.path])
    sweep = load(path)
    assert sweep.runs
    if sweep.definition.experiment:
        assert callable(_function(sweep.definition.experiment))


def test_thresholds_has_the_2000_runs_that_benchmarks_measure() -> None:
    sweep = load(ROOT / "examples" / "sweeps" / "thresholds.yaml")
    assert len(sweep.runs) == 2_000
    assert len(sweep.definition.programs) == 5


def test_every_figure_of_a_sweep_is_drawn_and_shown() -> None:
    pages = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("*.md"))
    for name in sweep_figures.DRAWN:
        assert f"(figures/{name}.svg)" in pages
        assert (ROOT / "docs" / "figures" / f"{name}.svg").is_file()


def test_a_camera_that_is_not_turned_gives_table_2_1() -> None:
    row = Experiment.draw(SETTINGS["thesis"], robustness.PATHS, 3).row("vector")
    for turned in ("pan", "tilt", "roll"):
        found = robustness.misaligned("vector", turned, 0, 3)
        assert found == {"rms": row.best, "seen": 1.0}
    assert triangulation.error("thesis", "vector", 3)["rms"] == row.best


@pytest.mark.parametrize(("turned", "sign"), [("pan", 0), ("tilt", 1), ("roll", 1)])
def test_turning_moves_the_picture_as_its_name_says(turned: str, sign: int) -> None:
    """Pan moves the columns and changes a depth most; the others leave it nearly as it was."""
    off = robustness.misaligned("similarity", turned, 1, 1)["rms"]
    exact = robustness.misaligned("similarity", turned, 0, 1)["rms"]
    assert off > exact
    assert (off < 2 * exact) == bool(sign)


@pytest.mark.long
def test_the_simulation_is_that_of_the_tracks() -> None:
    known = error_table(predictors.PATHS, 2)
    for motion in ("linear", "bouncing"):
        for predictor, value in known[motion].items():
            assert predictors.error("simulation", motion, predictor, 2)["rms"] == value


def test_a_quiet_sensor_finds_all_corners_and_a_dark_one_none() -> None:
    machine = load_machine("default")
    assert robustness.corners(machine, "keypoints_farthest", 90, 1)["within_3"] == 1
    assert robustness.corners(machine, "keypoints_farthest", 200, 1)["three"] == 0


@pytest.mark.parametrize("program", ["follow", "follow_many"])
def test_a_ball_on_a_circle_is_followed_and_one_without_contrast_is_not(program: str) -> None:
    machine = load_machine("default")
    found = robustness.followed(machine, program, 24, 1)
    error, seen = found["rms"], found["seen"]
    assert error is not None
    assert seen is not None
    assert error < 1.5
    assert seen > 0.9
    assert robustness.followed(machine, program, 255, 1) == {"rms": None, "seen": 0}


@pytest.mark.long
def test_robustness_is_what_its_script_measures() -> None:
    """The table of cameras; the whole page, which takes minutes, if all is to be thorough."""
    page = (ROOT / "docs" / "robustness.md").read_text(encoding="utf-8")
    assert robustness_page.misalignment() in page
    if THOROUGH:
        assert robustness_page.document() == page


@pytest.mark.long
def test_table_2_1_is_what_its_sweep_measures() -> None:
    from examples import fusion_table

    assert fusion_table.document() == fusion_table.PAGE.read_text(encoding="utf-8")


@pytest.mark.long
def test_rows_of_table_3_1_are_what_their_trainings_measure() -> None:
    """Those that take no training; all of them take ten minutes."""
    pytest.importorskip("scipy")
    page = orientation_page.PAGE.read_text(encoding="utf-8")
    for name in ("constant guess", "least squares"):
        found = [
            training.error(name, orientation_page.RENDERED, poses, seed)
            for poses in (1, 2, 3)
            for seed in (0, 1)
        ]
        place = np.mean([[each[axis] or 0 for axis in "xyz"] for each in found], axis=0)
        total = spread([each["total"] or 0 for each in found], 0)
        assert f"| {orientation_page.three(place, 1)} | {total} |" in page
