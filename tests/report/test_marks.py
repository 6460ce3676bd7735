"""Marks of programs that follow objects: paths, identities, predictions, windows."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from npchip import load_machine
from npchip.report.drawing import CYAN, GREEN, Scene, sheet
from npchip.report.marks import TAIL, frames_ahead, marks, shows_window, sights
from npchip.report.picture import render
from tests.support.clips import bundled_clips
from tests.support.programs import assembled, chip_with

if TYPE_CHECKING:
    from pathlib import Path

MOUSE = bundled_clips()["mouse_run"]


def test_one_object_has_its_whole_path_and_a_window_where_it_was_expected() -> None:
    result = chip_with("follow").run(MOUSE)
    (mark,) = marks(result, assembled("follow"), 40)
    assert len(mark.path) == int(result.outputs["valid"][:41].sum())
    assert mark.center == mark.path[-1] == (result.value("row", 40), result.value("col", 40))
    assert mark.predicted == (result.value("predicted_row", 40), result.value("predicted_col", 40))
    row, col = result.value("predicted_row", 39), result.value("predicted_col", 39)
    assert isinstance(row, int)
    assert isinstance(col, int)
    assert mark.window == (row - 6, col - 6, row + 5, col + 5)
    assert mark.name == ""


def test_a_miss_leaves_the_path() -> None:
    dark = np.concatenate([MOUSE[:20], np.zeros_like(MOUSE[:2])])
    result = chip_with("follow").run(dark)
    assert not result.value("valid", 21)
    (mark,) = marks(result, assembled("follow"), 21)
    assert len(mark.path) == int(result.outputs["valid"].sum())
    assert (mark.center, mark.predicted, mark.window) == (None, None, None)


def test_several_objects_have_their_identities() -> None:
    result = chip_with("follow_many").run(MOUSE)
    drawn = marks(result, assembled("follow_many"), 60)
    assert [mark.name for mark in drawn] == [str(name) for name in result.outputs["id"][60]]
    assert [mark.center for mark in drawn] == [seen.place for seen in sights(result, 60).values()]
    assert all(mark.window for mark in drawn if len(mark.path) > 1)
    assert max(len(mark.path) for mark in drawn) == TAIL


def test_places_of_16_bits_have_their_high_bytes() -> None:
    machine = replace(load_machine("default"), name="wide", np_rows=2, np_cols=40)
    frames = np.full((8, 16, 320), 120, np.uint8)
    for index in range(2, 8):
        frames[index, 4:12, 280 + index : 290 + index] = 20
    result = chip_with("follow_many_large", machine).run(frames)
    (mark,) = marks(result, assembled("follow_many_large", machine), 7)
    assert mark.center == (8, 292)
    assert mark.window is not None
    assert mark.window[1] > 255


def test_a_window_needs_the_prediction_for_the_next_frame() -> None:
    far = assembled("follow", "default", {"AHEAD": 4})
    result = chip_with("follow", "default", {"AHEAD": 4}).run(MOUSE[:20])
    assert not shows_window(far)
    assert marks(result, far, 19)[0].window is None
    assert shows_window(assembled("follow"))
    assert not shows_window(assembled("trajectory"))


@pytest.mark.parametrize("ahead", [1, 4])
def test_the_legend_says_how_far_ahead_a_prediction_is(ahead: int) -> None:
    chip = chip_with("follow", defines={"AHEAD": ahead})
    outputs = chip.run(bundled_clips()["mouse_run"][:2]).outputs
    assert frames_ahead(outputs, chip.program) == ahead
    assert frames_ahead({"row": [1]}, chip.program) == 0


def test_programs_without_places_have_no_marks() -> None:
    result = chip_with("imaging").run(MOUSE[:2])
    assert marks(result, assembled("imaging"), 1) == ()


def test_a_name_is_written_beside_its_object() -> None:
    result = chip_with("follow_many").run(MOUSE[:40])
    drawn = marks(result, assembled("follow_many"), 39)
    scene = Scene(MOUSE[39], "", "", marks=drawn)
    nameless = replace(scene, marks=tuple(replace(mark, name="") for mark in drawn))
    assert sheet([scene]) != sheet([nameless])


def test_the_picture_of_a_run_shows_windows_and_paths(tmp_path: Path) -> None:
    result = chip_with("follow_many").run(MOUSE[:30])
    render(result, assembled("follow_many"), list(MOUSE[:30]), tmp_path / "a.png")
    pixels = np.asarray(Image.open(tmp_path / "a.png").convert("RGB")).reshape(-1, 3)
    for color in (GREEN, CYAN):
        assert (pixels == color).all(axis=1).sum() > 100
