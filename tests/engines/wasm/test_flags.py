"""Flags that the compiled engine does not compute: which, and that nobody misses them."""

from __future__ import annotations

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.engines.wasm.translate.flags import Flags
from npchip.engines.wasm.translate.graph import build
from npchip.engines.wasm.translate.if_conversion import convert
from npchip.isa import ir, load_isa, parse_isa
from npchip.program.graph import Place
from tests.engines.wasm.test_engine import both
from tests.engines.wasm.test_extended import entry
from tests.support.chips import machine_of
from tests.support.lockstep import state, state_difference

MACHINE = machine_of()
BEFORE = "COL r0\nROW r1\nMOV r2, #200\n"
SOURCES = {
    # Source, and the flags that each step sets so that somebody may read them.
    "overwritten": ("ADD r0, #1\nSUB r1, r0\nCMP r1, r2\nMOV r3, r1", ["", "", "CZ", ""]),
    "read by an instruction": ("ADD r2, r2\nADC r1, r0\nSUB r3, r1", ["C", "", "CZ"]),
    "read and set": ("ADD r2, r2\nADC r1, r0\nADC r3, r1\nSUB r3, r1", ["C", "C", "", "CZ"]),
    "one of them set": ("ADD r2, #90\nSHL r2, #1\nAND r1, #1", ["", "C", "Z"]),
    "read by a condition": (
        "ADD r0, #1\nCMP r0, r1\nWHERE LO\nEND\nCMP r0, #9",
        ["", "CZ", "", "", "CZ"],
    ),
    "of all NPs, and then of some": (
        "CMP r0, #1\nWHERE LO\nADD r1, #1\nCMP r1, #2\nELSE\nCMP r1, r0\nCMP r1, #1\nEND\nNOP",
        ["CZ", "", "", "CZ", "", "", "CZ", "", ""],
    ),
    "of all NPs, then of some, and of all": (
        "CMP r0, #1\nWHERE LO\nCMP r1, #2\nEND\nCMP r1, #7",
        ["CZ", "", "", "", "CZ"],
    ),
    "under a condition": (
        "CMP r0, r1\nJANY LO, on\nCMP r2, #1\nCMP r1, #1\non: ADC r1, r1\nCMP r1, #4",
        ["CZ", "", "", "C", "", "CZ"],
    ),
}


@pytest.mark.parametrize("name", SOURCES)
def test_flags_that_nobody_reads_are_not_computed(name: str) -> None:
    source, expected = SOURCES[name]
    program = assemble_text(BEFORE + source + "\nHALT", "test.s", MACHINE)
    first, _ = convert(build(program, MACHINE, load_isa(), Place(0), 999), 999)
    needed = Flags().needed(first.steps)
    found = [
        "".join(sorted(item.name for item in statements if isinstance(item, ir.SetFlag)))
        for statements in needed
    ]
    assert found == ["", "", "", *expected]
    for step, statements in zip(first.steps, needed, strict=True):
        assert step.decoded is not None
        others = [s for s in step.decoded.form.statements if not isinstance(s, ir.SetFlag)]
        assert [s for s in statements if not isinstance(s, ir.SetFlag)] == others


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
