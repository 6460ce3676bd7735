"""One mask depth for each address, and flow that is hardly meant."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from npchip.assembler import assemble_text
from npchip.isa import load_isa
from npchip.program.checks import FlowFault, mask_depths


def words(text: str) -> tuple[int, ...]:
    return assemble_text(text).words


def depths(text: str) -> dict[int, int]:
    found, faults = mask_depths(assemble_text(text).decoded(load_isa()), 15)
    assert not faults
    return found


def faults(code: Sequence[int], limit: int = 15) -> list[FlowFault]:
    return mask_depths(list(map(load_isa().decode, code)), limit)[1]


def test_mask_depths() -> None:
    text = "WHERE EQ\nNOP\nWHERE LO\nELSE\nNOP\nEND\nEND\nHALT\nNOP"
    assert depths(text) == {0: 0, 1: 1, 2: 1, 3: 2, 4: 2, 5: 2, 6: 1, 7: 0}


def test_mask_depths_of_routines() -> None:
    """A routine has the depth of its calls, which must be the same."""
    text = "WHERE EQ\nCALL f\nCALL f\nEND\nHALT\nf: WHERE LO\nCALL g\nEND\nRET\ng: NOP\nRET"
    assert depths(text) == {0: 0, 1: 1, 2: 1, 3: 1, 4: 0, 5: 1, 6: 2, 7: 2, 8: 1, 9: 2, 10: 2}


def test_mask_depths_of_loops() -> None:
    assert depths("WHERE EQ\na: NOP\nJANY EQ, a\nEND\nHALT") == {0: 0, 1: 1, 2: 1, 3: 1, 4: 0}


SOURCES_OF_FAULTS = [
    ("END\nHALT", [("NP021", 0, None)]),
    ("ELSE\nHALT", [("NP021", 0, None)]),
    ("WHERE EQ\nJMP 0", [("NP020", 0, 1)]),
    ("NOP\nWHERE EQ\nJANY EQ, 1\nEND\nHALT", [("NP020", 1, 2)]),
    ("JANY EQ, 2\nWHERE EQ\nEND\nHALT", [("NP020", 2, 0)]),
    ("WHERE EQ\nJANY EQ, 3\nEND\nHALT", [("NP020", 3, 1)]),
    ("CALL 2\nHALT\nWHERE EQ\nRET", [("NP023", 3, None)]),
    ("WHERE EQ\nCALL 3\nHALT\nEND\nRET", [("NP023", 3, None)]),
    ("CALL 5\nWHERE EQ\nCALL 5\nEND\nHALT\nRET", [("NP020", 5, 2)]),
    # Out of a region that has its END: the jump that leaves it, not a later one back.
    ("NOP\nWHERE EQ\nJMP 5\nEND\nHALT\nNOP\nJMP 0", [("NP020", 0, 2)]),
    ("NOP\nWHERE EQ\nJANY EQ, 4\nNOP\nNOP\nJMP 0\nEND", [("NP020", 0, 5)]),
    ("NOP\nWHERE EQ\nJMP 4\nNOP\nJMP 0\nWHERE LO\nEND\nHALT", [("NP020", 0, 4)]),
    # One for each routine: a missing END is not told again at every loop around it.
    ("NOP\nNOP\nWHERE EQ\nJANY EQ, 1\nJMP 0", [("NP020", 1, 3)]),
    ("CALL 2\nJMP 5\nWHERE EQ\nJMP 2\nRET\nWHERE LO\nJMP 5", [("NP020", 2, 3), ("NP020", 5, 6)]),
    ("HALT\nEND", []),
    # Routines may share code that has one depth; the rules hold for each of them.
    ("CALL 3\nCALL 4\nHALT\nJMP 5\nNOP\nRET", []),
    ("CALL 3\nCALL 5\nHALT\nWHERE EQ\nJMP 6\nNOP\nEND\nRET", [("NP020", 6, 4)]),
    ("CALL 5\nWHERE EQ\nCALL 7\nEND\nHALT\nWHERE EQ\nJMP 7\nRET", [("NP023", 7, None)]),
    # Behind a call of a routine that never returns masks must nest all the same.
    ("CALL 2\nEND\nJMP 2", [("NP021", 1, None)]),
    # A program with very many places: a routine is looked at once.
    (
        "\n".join(f"CALL {60 + 20 * (n // 20)}" for n in range(60))
        + "\n"
        + "\n".join([*["CALL 80"] * 19, "RET", *["CALL 100"] * 19, "RET", "END", "RET"]),
        [("NP021", 100, None)],
    ),
]


@pytest.mark.parametrize(("text", "expected"), SOURCES_OF_FAULTS)
def test_mask_faults(text: str, expected: list[tuple[str, int, int | None]]) -> None:
    # Assembled behind a HALT, where masks do not matter: addresses are those of the text.
    code = [words(f"HALT\n{line}")[1] for line in text.split("\n")]
    found = faults(code)
    assert [(item.code, item.address, item.other) for item in found] == expected


@pytest.mark.parametrize(("limit", "depth", "ok"), [(15, 15, True), (15, 16, False), (2, 3, False)])
def test_mask_limit(limit: int, depth: int, ok: bool) -> None:
    code = words("HALT\n" + "WHERE EQ\n" * depth + "HALT")[1:]
    found = faults(code, limit)
    assert [item.code for item in found] == ([] if ok else ["NP022"])
