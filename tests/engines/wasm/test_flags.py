"""Flags that nobody reads cost nothing, and nobody misses them."""

from __future__ import annotations

import re

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.isa import parse_isa
from tests.engines.wasm.test_engine import both
from tests.engines.wasm.test_extended import entry
from tests.support.chips import machine_of
from tests.support.compiled import compiled
from tests.support.lockstep import state, state_difference

MACHINE = machine_of()
BEFORE = "COL r0\nROW r1\nMOV r2, #200\n"
SOURCES = {
    # Source, and the flags that each step must set since somebody may read them.
    "overwritten": ("ADD r0, r1\nSUB r1, r0\nCMP r1, r2\nMOV r3, r1", ["", "", "CZ", ""]),
    "read by an instruction": ("ADD r2, r2\nADC r1, r0\nSUB r3, r1", ["C", "", "CZ"]),
    "read and set": ("ADD r2, r2\nADC r1, r0\nADC r3, r1\nSUB r3, r1", ["C", "C", "", "CZ"]),
    "one of them set": ("ADD r2, r1\nADD r2, r2\nAND r1, r0", ["", "C", "Z"]),
    "read by a condition": (
        "ADD r0, r2\nCMP r0, r1\nWHERE LO\nEND\nCMP r0, #9",
        ["", "CZ", "", "", "CZ"],
    ),
    "of all NPs, and then of some": (
        "CMP r0, #1\nWHERE LO\nADD r1, r2\nCMP r1, #2\nELSE\nCMP r1, r0\nCMP r1, #1\nEND\nNOP",
        ["CZ", "", "", "CZ", "", "", "CZ", "", ""],
    ),
    "of all NPs, then of some, and of all": (
        "CMP r0, #1\nWHERE LO\nCMP r1, r2\nEND\nCMP r1, #7",
        ["CZ", "", "", "", "CZ"],
    ),
    "under a condition": (
        "CMP r0, r1\nJANY LO, on\nCMP r2, r0\nCMP r1, r0\non: ADC r1, r1\nCMP r1, #4",
        ["CZ", "", "", "C", "", "CZ"],
    ),
}
SETS = {
    "ADD": "C = carry(rd, rs)\nrd = rd + rs\nZ = rd == 0",
    "ADC": "c = C\nC = carry(rd, rs, c)\nrd = rd + rs + byte(c)\nZ = Z and rd == 0",
    "SUB": "C = borrow(rd, rs)\nrd = rd - rs\nZ = rd == 0",
    "CMP": "C = borrow(rd, rs)\nZ = rd == rs",
}
VARIANTS = [(name, flags) for name in SETS for flags in ("", "C", "Z")]
SPARING = parse_isa(
    "extends: npchip\nname: test\ninstructions:\n"
    + "".join(
        entry(
            f"{name}_{flags}",
            "{rd}, {rs}",
            f"1111 dddd ssss {number:04b}",
            "\n".join(
                line for line in SETS[name].splitlines() if line[0] not in "CZ" or line[0] in flags
            )
            or "t = rd",
        )
        for number, (name, flags) in enumerate(VARIANTS)
    ),
    "test.yaml",
)
"""Instructions such as ``ADD_C`` that set fewer flags."""


def spared(source: str, flags: list[str]) -> str:
    """Return a source whose instructions set those flags only."""
    lines = []
    for line, needed in zip(source.splitlines(), flags, strict=True):
        name = next((name for name in SETS if re.search(rf"\b{name}\b", line)), "")
        lines.append(line.replace(name, f"{name}_{needed}") if name and needed != "CZ" else line)
    return "\n".join(lines)


@pytest.mark.parametrize("name", SOURCES)
def test_flags_that_nobody_reads_cost_nothing(name: str) -> None:
    source, flags = SOURCES[name]
    assert spared(source, flags) != source
    sizes = [
        compiled(f"{BEFORE}{text}\nHALT", MACHINE, SPARING).size
        for text in (source, spared(source, flags))
    ]
    assert sizes[0] == sizes[1]


@pytest.mark.parametrize("name", SOURCES)
def test_nobody_misses_them(name: str) -> None:
    both(BEFORE + SOURCES[name][0] + "\nHALT")


def test_flags_before_a_branch_that_asks_registers() -> None:
    isa = parse_isa(
        "extends: npchip\nname: test\ninstructions:\n"
        + entry("LEAP", "{rd}, {port}", "1111 dddd pppp 1011", "if any(rd == 1):\n    jump(port)"),
        "test.yaml",
    )
    source = BEFORE + "CMP r0, #2\nLEAP {}, 6\nCMP r1, #1\nHALT"
    rows, cols = np.indices(MACHINE.geometry)
    for register, expected in (("r0", cols == 2), ("r2", rows == 1)):
        program = assemble_text(source.format(register), "test.s", MACHINE, isa=isa)
        chips = [Chip(program, MACHINE, engine, isa) for engine in ("reference", "wasm")]
        for chip in chips:
            chip.run()
            np.testing.assert_array_equal(chip.flags["Z"], expected)
        assert not state_difference(*map(state, chips))


def test_a_flag_that_one_instruction_sets_for_all_and_then_for_some() -> None:
    semantics = "Z = rd == 3\nmask_push(C)\nZ = rs == 1"
    isa = parse_isa(
        "extends: npchip\nname: test\ninstructions:\n"
        + entry("TWICE", "{rd}, {rs}", "1111 dddd ssss 0000", semantics),
        "test.yaml",
    )
    source = BEFORE + "CMP r0, #2\nTWICE r0, r1\nEND\nHALT"
    program = assemble_text(source, "test.s", MACHINE, isa=isa)
    chips = [Chip(program, MACHINE, engine, isa) for engine in ("reference", "wasm")]
    rows, cols = np.indices(MACHINE.geometry)
    for chip in chips:
        chip.run()
        np.testing.assert_array_equal(chip.flags["Z"], np.where(cols < 2, rows == 1, cols == 3))
    assert not state_difference(*map(state, chips))
