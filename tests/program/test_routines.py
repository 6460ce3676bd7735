"""The routines of a program."""

from __future__ import annotations

import pytest

from npchip import assemble_text
from npchip.isa import load_isa
from npchip.program.graph import RESET, Place
from npchip.program.routines import Finder, find_routines


def routines(text: str) -> dict[int, list[int]]:
    code = assemble_text(text).decoded(load_isa())
    return {entry: sorted(places) for entry, places in find_routines(code, 15).items()}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("NOP\nHALT\nNOP", {0: [0, 1]}),
        ("CALL 2\nHALT\nNOP\nRET", {0: [0, 1], 2: [2, 3]}),
        # Behind a call flow goes on only if the routine returns.
        ("CALL 2\nHALT\nJMP 2", {0: [0], 2: [2]}),
        ("CALL 2\nHALT\nCALL 4\nRET\nHALT", {0: [0], 2: [2], 4: [4]}),
        # It may return later than it calls itself, or by the end of another.
        ("CALL 2\nHALT\nJANY EQ, 5\nCALL 2\nNOP\nRET", {0: [0, 1], 2: [2, 3, 4, 5]}),
        ("CALL 2\nHALT\nCALL 2\nRET", {0: [0], 2: [2]}),
        ("CALL 3\nCALL 4\nHALT\nNOP\nRET", {0: [0, 1, 2], 3: [3, 4], 4: [4]}),
        (
            "CALL 2\nHALT\nJANY EQ, 6\nCALL 5\nRET\nCALL 2\nRET",
            {0: [0, 1], 2: [2, 3, 4, 6], 5: [5, 6]},
        ),
        # The program itself may be called, and what lies behind its end is no part of it.
        ("JANY EQ, 3\nCALL 0\nHALT\nRET", {0: [0, 1, 2, 3]}),
        ("CALL 7\nHALT", {0: [0], 7: []}),
    ],
)
def test_what_a_routine_reaches(text: str, expected: dict[int, list[int]]) -> None:
    assert routines(text) == expected


def test_open_calls_are_callers() -> None:
    code = assemble_text("NOP\nHALT\nNOP\nRET\nNOP\nRET").decoded(load_isa())
    finder = Finder(code, 15, Place(4, (1, 2), 3))
    assert finder.own.places == {Place(4, (), 3), Place(5, (), 3)}
    assert finder.own.continuations == {3: {Place(2, (), 3): None}}
    assert {place: [list(each) for each in found] for place, found in finder.returns.items()} == {
        Place(5, (), 3): [[Place(2, (), 3)]],
        Place(3, (), 3): [[Place(1, (), 3)]],
    }


def test_a_place_that_is_refused_is_not_followed() -> None:
    code = assemble_text("NOP\nJANY EQ, 3\nHALT\nHALT").decoded(load_isa())
    seen: list[tuple[int, int]] = []

    def arrive(_routine: object, place: Place, origin: int) -> bool:
        seen.append((place.address, origin))
        return place.address != 1

    finder = Finder(code, 15, arrive=arrive)
    assert seen == [(0, -1), (1, 0)]
    assert finder.own.places == {RESET}
