"""`.position`: outputs that are a place."""

from __future__ import annotations

import json
from typing import Any

import pytest

from npchip import assemble, assemble_text
from npchip.base.errors import InputError, NpchipError
from npchip.formats import npo
from npchip.isa import load_isa
from npchip.program.model import Position

SOURCE = """
.equ STEPS, 3
.output row, 0, scalar
.output col, 1, scalar16
.output many, 2, list
{}
        OUT     0, r0
        OUT     1, r0
        OUT     1, r0
        OUT     2, r0
        HALT
"""


def test_positions_are_those_of_the_source_and_of_the_object() -> None:
    program = assemble_text(SOURCE.format(".position row, col\n.position row, col, STEPS - 1"))
    assert program.positions == (Position("row", "col", 0), Position("row", "col", 2))
    text = npo.to_text(program, load_isa())
    assert npo.from_text(text, "program.npo", load_isa()) == program


def test_an_object_of_before_has_none() -> None:
    document = json.loads(npo.to_text(assemble("tracking"), load_isa()))
    del document["positions"]
    assert npo.from_text(json.dumps(document), "old.npo", load_isa()).positions == ()


@pytest.mark.parametrize(
    ("line", "code"),
    [
        (".position row", "NP011"),
        (".position row, col, 1, 2", "NP011"),
        (".position row, row", "NP033"),
        (".position row, many", "NP033"),
        (".position row, STEPS", "NP033"),
        (".position row, col, 1001", "NP006"),
        (".position row, col, 0 - 1", "NP006"),
        (".position row, col\n.position row, col, 0", "NP008"),
    ],
)
def test_what_is_no_place_is_refused(line: str, code: str) -> None:
    with pytest.raises(NpchipError, match=rf"\[{code}\]"):
        assemble_text(SOURCE.format(line))


@pytest.mark.parametrize("wrong", [[["row", "col"]], [["row", "?", 0]], [["row", "col", -1]], 7])
def test_damaged_positions_of_an_object_are_refused(wrong: Any) -> None:
    program = assemble_text(SOURCE.format(".position row, col"))
    document = json.loads(npo.to_text(program, load_isa())) | {"positions": wrong}
    with pytest.raises(InputError, match="NP111"):
        npo.from_text(json.dumps(document), "program.npo", load_isa())


def test_the_trajectory_programs_say_where_the_object_is_and_will_be() -> None:
    assert [item.ahead for item in assemble("trajectory").positions] == [0, 1]
    assert [item.ahead for item in assemble("tracking").positions] == [0]
