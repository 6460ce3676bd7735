"""Scores against true places, and how well asm/follow.s follows the mouse."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from examples import score_track
from npchip.host.vision.truth import (
    Score,
    entries_of,
    places_of,
    read_truth,
    score,
    score_many,
)
from tests.support.clips import CLIPS, bundled_clips
from tests.support.programs import chip_with

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

TRUTH = CLIPS / "truth"


def straight(frames: int, speed: float = 1) -> dict[str, dict[int, NDArray[np.float64]]]:
    """Return an object that moves to the right from (10, 20)."""
    return {"ball": {frame: np.array([10, 20 + speed * frame]) for frame in range(frames)}}


def outputs(places: list[tuple[int, int] | None]) -> dict[str, NDArray[np.int32]]:
    """Return the outputs of a program that has measured these places."""
    valid = np.array([place is not None for place in places], np.int32)
    row, col = np.array([place or (0, 0) for place in places], np.int32).T
    return {"valid": valid, "row": row, "col": col}


def test_a_truth_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "truth.json"
    points = [[1.5, 2.5], None, [3, 4]]
    path.write_text(json.dumps({"objects": {"a": {"start": 5, "points": points}}}))
    read = read_truth(path)
    assert {frame: place.tolist() for frame, place in read["a"].items()} == {
        5: [1.5, 2.5],
        7: [3, 4],
    }


def test_perfect_measurements_stay_behind_by_the_speed() -> None:
    measured, predicted = places_of(outputs([(10, 20 + frame) for frame in range(12)]))
    assert score(straight(12), measured, predicted, 1) == Score(1, 1, 1, 1, 1)
    assert score(straight(12), measured, predicted, 4) == Score(1, 4, 4, 4, 4)


def test_predictions_are_compared_with_the_later_place() -> None:
    sent = outputs([(10, 20 + frame) for frame in range(12)])
    sent |= {"predicted_row": sent["row"], "predicted_col": sent["col"] + 4}
    assert score(straight(12), *places_of(sent), 4) == Score(1, 0, 0, 4, 4)


def test_a_miss_counts_with_the_last_place() -> None:
    measured, predicted = places_of(outputs([(10, 20), (10, 21), None, None]))
    found = score(straight(4), measured, predicted)
    assert found.valid == pytest.approx(0.5)
    assert found.rms == pytest.approx(np.sqrt((1 + 1 + 4) / 3))  # frame 3 has no next place


def test_an_object_at_rest_does_not_count() -> None:
    measured, predicted = places_of(outputs([(10, 20)] * 12))
    found = score(straight(12, speed=0.05), measured, predicted)
    assert found.valid == 1
    assert np.isnan([found.rms, found.median, found.stays_rms, found.stays_median]).all()


def test_the_nearest_object_is_the_one_that_is_followed() -> None:
    objects = straight(12) | {"far": {frame: np.array([50, 70]) for frame in range(12)}}
    measured, predicted = places_of(outputs([(49, 69)] * 12))
    assert score(objects, measured, predicted).rms == pytest.approx(np.sqrt(2))


def test_fractions_and_centres_of_boxes_are_places() -> None:
    sent = outputs([(10, 20), None])
    sent |= {"row_sub": np.array([64, 0]), "col_sub": np.array([128, 0])}
    measured, _ = places_of(sent)
    assert measured[0].tolist() == [10.25, 20.5]
    assert np.isnan(measured[1]).all()
    boxes = {"valid": [1], "center_row": [7], "center_col": [8]}
    assert places_of({k: np.array(v, np.int32) for k, v in boxes.items()})[0].tolist() == [[7, 8]]


def lists(*frames: list[tuple[int, int, int]] | None) -> dict[str, list[list[int] | None]]:
    """Return what a program sends that sees these (number, row, column) and predicts rest."""
    columns = [[None if f is None else [one[n] for one in f] for f in frames] for n in range(3)]
    names = ("id", "row", "col", "predicted_row", "predicted_col")
    return dict(zip(names, [*columns, *columns[1:]], strict=True))


def test_several_objects_are_scored_one_by_one() -> None:
    objects = straight(3) | {"far": {frame: np.array([50, 70]) for frame in range(3)}}
    sent = lists([(1, 10, 20), (2, 50, 71)], None, [(2, 50, 70), (7, 10, 20)])
    found = score_many(objects, entries_of(sent))
    assert found.seen == pytest.approx(4 / 6)
    assert found.switches == 1  # the ball was 1 and is 7
    assert found.rms == found.stays_rms == pytest.approx(1)  # in frame 0 only, both


def test_what_is_far_from_an_object_is_not_it() -> None:
    found = score_many(straight(2), entries_of(lists([(1, 10, 27)], [(1, 10, 27)])))
    assert found.seen == pytest.approx(1 / 2)


def test_an_entry_stands_for_one_object() -> None:
    objects = straight(1) | {"twin": {0: np.array([10, 22])}}
    assert score_many(objects, entries_of(lists([(1, 10, 21)]))).seen == pytest.approx(1 / 2)


@cache
def mouse(rms: float, light: float, ahead: int) -> Score:
    frames = bundled_clips()["mouse_run"]
    noise = np.random.default_rng(7).normal(0, rms, frames.shape)
    frames = np.clip(np.rint(frames * light + noise), 0, 255).astype(np.uint8)
    sent = chip_with("follow", "default", {"AHEAD": ahead}).run(frames).outputs
    return score(read_truth(TRUTH / "mouse_run.json"), *places_of(sent), ahead)


@pytest.mark.parametrize(("rms", "light"), [(0, 1), (2, 1), (5, 1), (10, 1), (0, 0.6)])
def test_the_mouse_is_followed(rms: float, light: float) -> None:
    found = mouse(rms, light, 1)
    assert found.valid >= 0.95
    assert found.median <= 1.5
    assert found.rms <= 2.6
    far = mouse(rms, light, 4)
    assert far.rms <= 0.75 * far.stays_rms


def test_the_tool_scores_several_objects(capsys: pytest.CaptureFixture[str]) -> None:
    clip, truth = CLIPS / "mouse_run.npy", TRUTH / "mouse_run.json"
    score_track.main(["follow_many", str(clip), str(truth)])
    sent = chip_with("follow_many").run(bundled_clips()["mouse_run"]).outputs
    found = score_many(read_truth(truth), entries_of(sent))
    assert found.median <= 1.5
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == f"seen       {found.seen:.0%} of the frames of all objects"
    assert lines[1] == f"identity   {found.switches} switches"
    assert lines[2] == f"prediction rms {found.rms:.2f} px, median {found.median:.2f} px"


def test_the_frame_difference_stays_right_for_the_ball() -> None:
    """The ball never leaves its first place, so `follow.s` finds only what changes of it."""
    sent = chip_with("trajectory").run(bundled_clips()["ball_fall_30000fps"]).outputs
    assert score(read_truth(TRUTH / "ball_fall_30000fps.json"), *places_of(sent)).rms <= 1.1


def test_the_tool_prints_the_score(capsys: pytest.CaptureFixture[str]) -> None:
    clip, truth = CLIPS / "mouse_run.npy", TRUTH / "mouse_run.json"
    score_track.main(["follow", str(clip), str(truth), "--ahead", "4", "--define", "AHEAD=4"])
    lines = capsys.readouterr().out.splitlines()
    far = mouse(0, 1, 4)
    assert lines[1] == f"prediction rms {far.rms:.2f} px, median {far.median:.2f} px"
    assert lines[2] == f"stays      rms {far.stays_rms:.2f} px, median {far.stays_median:.2f} px"
