"""Long work in the status line, and the sources of frames: what comes late takes nothing over."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tests.support.page_code import Bundles, run

pytestmark = pytest.mark.long

OFF, ON = False, True


@pytest.fixture(scope="module")
def player(bundles: Bundles) -> Any:
    """The player's state after choices that overtook each other."""
    return json.loads(run(bundles.for_node("shell/player.ts")))


def test_a_camera_that_is_chosen_twice_is_on_once(player: Any) -> None:
    assert sorted(player["twice"]["lights"]) == [OFF, ON]
    assert player["twice"]["now"] == ["camera", "live"]


def test_a_camera_that_is_allowed_too_late_goes_off(player: Any) -> None:
    assert player["late"] == {"lights": [OFF], "now": ["page", "own"]}


def test_a_file_that_is_read_too_late_is_not_used(player: Any) -> None:
    assert player["cancel"] == "function"
    assert player["reading"] == {"now": ["page", "own"], "progress": None}


def test_each_job_shows_and_ends_its_own(bundles: Bundles) -> None:
    found = json.loads(run(bundles.for_node("shell/jobs.ts")))
    reading = "Reading 0.5 Cancel"
    assert found["shown"] == [
        reading,
        "Looking back 0.25 -",
        reading,
        "Fetching null -",
        reading,
        None,
        None,
    ]
    assert found["silent"]
    assert found["failed"] == {"kind": "error", "text": "it failed"}


@pytest.fixture(scope="module")
def checks(bundles: Bundles) -> Any:
    """Results of checks that something happens to."""
    return json.loads(run(bundles.for_node("shell/checking.ts")))


def test_a_check_is_of_one_text(checks: Any) -> None:
    assert checks["texts"] == ["new", "new"]
    assert checks["edited"]["text"] == "old"
    for name in ("edited", "late"):
        assert "changed during the check" in checks[name]["said"]
        assert (checks[name]["verdicts"], checks[name]["shown"]) == (None, None)


def test_a_check_can_be_cancelled(checks: Any) -> None:
    wanted = {"said": "The check was cancelled", "kind": "info", "shown": None, "verdicts": None}
    assert checks["cancelled"] == wanted


def test_a_new_check_takes_the_place_of_one_at_work(checks: Any) -> None:
    assert checks["twice"]["verdicts"] == ["holds"]
    assert "expectations hold" in checks["twice"]["said"]


def test_lines_of_an_edited_text_are_those_of_the_program_in_the_chip(bundles: Bundles) -> None:
    found = json.loads(run(bundles.for_node("shell/lines.ts")))
    assert found == {
        "same": [1, 2, 3, 4, 5],
        "pushed": [None, 1, 2, 3, 4, 5],
        "deleted": [1, 4, 5],
        "edited": [1, 2, None, 4, 5],
        "two": [1, None, 2, 3, 4, None, 5],
        "twins": None,
        "addresses": [[0, 3], [0, 3], [], [2]],
    }


def test_breakpoints_and_ways_are_of_the_program_in_the_chip(bundles: Bundles) -> None:
    found = json.loads(run(bundles.for_node("shell/breaking.ts")))
    assert (found["before"], found["after"]) == ([[1]], [[1]])
    # The newer program is in the chip before the way to the line is looked for.
    assert (found["anew"], found["travel"]) == ([[1]], {"to": "cursor", "addresses": [1]})
    # Each condition is read with the names of the program in the chip at the time.
    assert (found["condition"], found["again"]) == (["r0 > 1", 0], ["r0 > 1", 1])
    assert found["why"][0] is None
    assert "a line with an instruction" in found["why"][1]


def test_run_pressed_during_a_step_back_begins_at_its_end(bundles: Bundles) -> None:
    found = json.loads(run(bundles.for_node("shell/resting.ts")))
    assert found == {"paused": False, "running": True, "asked": "run"}


def test_the_pace_of_clips_and_cameras(bundles: Bundles) -> None:
    found = json.loads(run(bundles.for_node("shell/paces.ts")))
    slow, clip = ({"unit": "frames", "rate": rate} for rate in (15, 25))
    assert (found["chosen"], found["clip"], found["unstated"]) == (slow, clip, slow)
    # A camera gives 30 frames a second: what asks for as many does not hold it back.
    steps = {"unit": "steps", "rate": 50}
    assert found["camera"] == ["max", {"unit": "frames", "rate": 5}, "max", steps]
    assert found["drawing"] is True
    assert found["wrong"] == [None] * 4
