"""The array in the studio's page: what moved, what changed, and the keys, asked in Node."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import Chip, Program, assemble_text
from tests.studio.array.asking import after, ask, ask_alone, info_of, view_of
from tests.support.page_code import Answers
from tests.support.programs import assembled

pytestmark = pytest.mark.long


def test_a_moment_is_compared_with_the_stop_before_it(harness: Answers) -> None:
    program = assembled("edges")
    views = {count: view_of(after(program, count)) for count in (0, 1, 9, 10, 11)}
    events: list[dict[str, Any]] = [
        {"view": views[0]},
        {"running": True, "view": views[1]},
        {"running": False},
        {"running": True},
        {"view": views[9]},
        {"view": views[10]},
        {"running": False},
        {"view": views[10]},
        {"view": views[9]},
        {"program": info_of(program)},
        {"view": views[11]},
    ]
    found = ask_alone(harness, "story", events=events)
    assert [each["reference"] for each in found] == [None, 0, 0, 0, 1, 1, 1, 1, 10, None, 9]


def neighbours() -> tuple[Program, int]:
    """A program and how many steps lead to its first read of a neighbour."""
    program = assembled("edges")
    chip = after(program, 0)
    count = 0
    while not info_of(program)["words"][chip.pc]["moves"]:
        chip.step()
        count += 1
    return program, count


def test_values_pass_after_a_step_over_a_read_of_a_neighbour(harness: Answers) -> None:
    program, count = neighbours()
    made = info_of(program)
    views = [view_of(after(program, count + step)) for step in range(-1, 2)]
    moved = made["words"][views[1]["address"]]["moves"]
    slow, fast = {"unit": "steps", "rate": 2}, {"unit": "steps", "rate": 60}
    told = {**views[2], "last": views[1]["address"]}
    events: list[dict[str, Any]] = [
        {"program": made},
        {"view": views[0]},
        {"view": views[1]},
        {"view": views[2]},
        {"view": views[2]},
        {"running": True, "pace": fast},
        {"pace": slow},
        {"running": False, "view": views[1]},
        {"view": views[0]},
        {"view": told},
        {"view": {**views[1], "last": None}},
    ]
    found = [each["passing"] for each in ask_alone(harness, "story", events=events)]
    seen = {"moves": moved, "from": views[1]["instructions"]}
    unseen = {"moves": moved, "from": None}
    assert found == [None, None, None, seen, seen, None, seen, None, None, unseen, None]


@pytest.mark.parametrize("direction", ["north", "east", "south", "west"])
def test_arrows_carry_what_the_nps_took(harness: Answers, direction: str) -> None:
    program = assemble_text(f"CMP r1, #100\nWHERE LO\nNBR r5, r9, {direction}\nHALT", "nbr.s")
    chip = Chip(program, engine="reference")
    values = np.random.default_rng(3).permutation(256)[:80].reshape(8, 10)
    chip.registers[9] = chip.registers[1] = values
    chip.step()
    chip.step()
    before = view_of(chip, registers=chip.registers.copy())
    active = chip.active.copy()
    assert 10 < active.sum() < 70
    (move,) = info_of(program)["words"][2]["moves"]
    question = {"move": move, "from": before, "active": active, "rows": 8, "cols": 10}
    arrows = ask(harness, "arrows", **question)
    chip.step()
    assert {(each["row"], each["column"]) for each in arrows} == {
        (row, column) for row, column in np.argwhere(active).tolist()
    }
    for each in arrows:
        assert each["value"] == chip.registers[5][each["row"], each["column"]]


def test_arrows_of_a_large_array_are_few(harness: Answers) -> None:
    active: NDArray[np.uint8] = np.ones(60 * 80, np.uint8)
    registers = np.zeros(16, np.uint8)
    question = {"move": {"row": 0, "column": 1, "register": None}, "from": {"registers": registers}}
    arrows = ask(harness, "arrows", **question, active=active, rows=60, cols=80)
    assert 200 <= len(arrows) <= 400
    assert {each["value"] for each in arrows} == {None}


# ---- keys


def test_every_way_has_keys_of_its_own_that_are_heard(harness: Answers) -> None:
    keys = [
        {"key": "F11"},
        {"key": "F11", "ctrlKey": True},
        {"key": "F11", "shiftKey": True},
        {"key": "F11", "altKey": True},
        {"key": "s"},
        {"key": "S", "shiftKey": True},
        {"key": "s", "ctrlKey": True},
        {"key": "R"},
        {"key": "x"},
    ]
    found = ask(harness, "ways", keys=keys)
    letters = ["Step", "Step back", None, "Run back", None]
    assert found["everywhere"] == ["Step", "Step back", "Step out", None] + [None] * 5
    assert found["withLetters"] == [*found["everywhere"][:4], *letters]
    ways = found["shortcuts"]
    for column in ("name", "letter", "key", "does"):
        used = [way[column] for way in ways if way[column] is not None]
        assert len(set(used)) == len(used) >= 10
    assert (
        {"step", "over", "out", "cursor", "frame"}
        == {way["to"] for way in ways if not way["back"]}
        == {way["to"] for way in ways if way["back"]} - {"end"}
    )


def test_arrow_keys_stay_within_the_grid(harness: Answers) -> None:
    presses: dict[tuple[Any, ...], tuple[int, int] | None] = {
        ("ArrowUp", False, 0, 3, 8, 10): (0, 3),
        ("ArrowDown", False, 6, 3, 8, 10): (7, 3),
        ("ArrowLeft", False, 6, 0, 8, 10): (6, 0),
        ("ArrowRight", False, 6, 8, 8, 10): (6, 9),
        ("PageDown", False, 2, 8, 8, 10): (6, 8),
        ("PageUp", False, 2, 8, 8, 10): (0, 8),
        ("Home", False, 2, 8, 8, 10): (2, 0),
        ("End", True, 2, 8, 8, 10): (7, 9),
        ("Home", True, 2, 8, 8, 10): (0, 0),
        ("a", False, 2, 8, 8, 10): None,
    }
    found = ask(harness, "keys", presses=list(presses))
    wanted = [to and {"row": to[0], "column": to[1]} for to in presses.values()]
    assert found == wanted
