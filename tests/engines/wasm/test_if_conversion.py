"""Branches that the compiled engine turns into conditions: which, and that they count the same."""

from __future__ import annotations

import re

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.engines.rows import EXECUTED, TAKEN
from tests.engines.wasm.test_engine import both
from tests.support.chips import machine_of
from tests.support.compiled import Compiled, compiled

MACHINE = machine_of()
PLAIN = "ADD r1, #3\nADC r2, r1\nSUB r3, r2\nMOV r4, r3\n"
CONVERTED = {
    "one step": "JNONE LO, on\nADD r1, #1\non: OUT 0, r1\nHALT",
    "four steps": f"JANY LO, on\n{PLAIN}on: OUT 0, r4\nHALT",
    "two after each other": (
        f"JNONE LO, on\n{PLAIN}on: JANY CS, over\nADD r5, #9\nover: OUT 0, r5\nHALT"
    ),
    "in a mask": (
        "WHERE LO\nSHL r1, #1\nJNONE CS, on\nADC r2, r2\non: ADD r2, r1\nEND\nOUT 0, r2\nHALT"
    ),
    "around a neighbour's wish": (
        "CMP r0, r1\nWHERE LO\nJNONE LO, on\nADD r1, r0\non: NBR r3, r1, east\nEND\nOUT 0, r3\nHALT"
    ),
    "flags it leaves": "JANY LO, on\nCMP r3, #1\non: ADC r1, r1\nJNONE EQ, end\nNOP\nend: HALT",
}
"""Sources in which every branch becomes a condition, behind `BEFORE`."""
KEPT = {
    "five steps": f"JANY LO, on\nCOL r5\n{PLAIN}on: HALT",
    "a load": "JANY LO, on\nLD r1, [r2 + 0]\non: HALT",
    "a store": "JANY LO, on\nST [5], r2\non: HALT",
    "a neighbour": "JANY LO, on\nNBR r1, r2, west\non: HALT",
    "an output": "JANY LO, on\nOUT 0, r2\non: HALT",
    "a mask": "JANY LO, on\nWHERE EQ\nMOV r1, r2\nEND\non: HALT",
    "a jump elsewhere": "JANY LO, on\nMOV r1, #1\nJMP end\non: MOV r1, #2\nend: HALT",
    "another way to it": "JANY EQ, in\nJANY LO, on\nin: MOV r1, #1\non: HALT",
    "a loop": "l: ADD r1, #1\nJNONE CS, l\nHALT",
    "a jump to what follows": "JANY LO, on\non: HALT",
}
BEFORE = "COL r0\nROW r1\nMOV r2, r1\nADD r2, r0\nMOV r3, #7\nCMP r0, #{limit}\n"


def shape_of(source: str) -> Compiled:
    return compiled(BEFORE.format(limit=2) + source, MACHINE)


@pytest.mark.parametrize("source", CONVERTED.values(), ids=CONVERTED)
def test_a_branch_around_a_few_plain_steps_is_converted(source: str) -> None:
    program = assemble_text(BEFORE.format(limit=2) + source, "test.s", MACHINE)
    made = shape_of(source)
    assert made.blocks == (len(program.words) - 1, 1)  # all of it, and the halt
    assert not made.branches


@pytest.mark.parametrize("source", KEPT.values(), ids=KEPT)
def test_any_other_branch_is_kept(source: str) -> None:
    assert shape_of(source).branches == len(re.findall("JANY|JNONE", source))


@pytest.mark.parametrize("limit", [0, 1, 2, 255])  # no NP, some NPs, all NPs are lower
@pytest.mark.parametrize("name", CONVERTED)
def test_converted_branches_do_and_count_the_same(name: str, limit: int) -> None:
    slow, fast = both(BEFORE.format(limit=limit) + CONVERTED[name])
    assert fast.executions.tolist() == slow.executions.tolist()


@pytest.mark.parametrize("limit", [0, 1, 2, 255])
@pytest.mark.parametrize(
    "source",
    [
        # The flags come from another block and are set anew in this one.
        (
            "JANY EQ, on\nMOV r4, #1\nNOP\nNOP\nNOP\nNOP\non: JNONE LO, end\nMOV r5, #1\n"
            "end: MOV r5, #2\nCMP r2, r0\nHALT"
        ),
        # What decides is loaded before it is stored over.
        (
            "ST [10], r1\nMOV r9, #250\nJANY EQ, on\nNOP\nNOP\nNOP\nNOP\nNOP\n"
            "on: LD r8, [10]\nCMP r8, #250\nMOV r8, #0\nST [10], r9\nJNONE EQ, end\nMOV r5, #1\n"
            "end: MOV r5, #2\nCMP r2, r0\nHALT"
        ),
    ],
)
def test_steps_whose_results_nobody_needs_are_counted(source: str, limit: int) -> None:
    slow, fast = both(BEFORE.format(limit=limit) + source)
    assert fast.executions.tolist() == slow.executions.tolist()


@pytest.mark.parametrize("limit", range(1, 30))
def test_a_run_may_begin_between_a_branch_and_where_it_leads(limit: int) -> None:
    source = (
        "MOV r0, #3\nl: CMP r1, #90\nJANY HS, on\nADD r1, #40\nADD r2, r0\nADC r3, r2\n"
        "on: ADD r0, #1\nCMP r0, #9\nJANY LO, l\nHALT"
    )
    program = assemble_text(source, "test.s", MACHINE)
    chips = [Chip(program, MACHINE, engine) for engine in ("reference", "wasm")]
    found = []
    for chip in chips:
        chip.run(max_cycles=limit)
        chip.run()
        found.append((chip.registers.tolist(), chip.cycles, chip.executions.tolist()))
    assert found[0] == found[1]


def test_a_search_in_a_loop_does_and_counts_the_same() -> None:
    """The largest of all NPs bit by bit, eight passes that become one block, and a profile."""
    source = (
        "ROW r0\nSHL r0, #4\nCOL r1\nOR r0, r1\nMOV r2, #0\nMOV r4, #8\n"
        "l: ADD r2, r2\nSHL r0, #1\nJNONE CS, clear\nSBC r3, r3\nAND r0, r3\nOR r2, #1\n"
        "clear: SUB r4, #1\nJANY NE, l\nHALT\n"
    )
    both(source)
    program = assemble_text(source, "test.s", MACHINE)
    chips = [Chip(program, MACHINE, engine, profile=True) for engine in ("reference", "wasm")]
    most = (MACHINE.np_rows - 1) << 4 | MACHINE.np_cols - 1
    counts = []
    for chip in chips:
        chip.run()
        assert np.unique(chip.registers[2]).tolist() == [most]
        assert chip.counts is not None
        counts.append(chip.counts.total())
    np.testing.assert_array_equal(counts[0], counts[1])
    branch = 8
    assert counts[1][TAKEN, branch] == 8 - most.bit_count()
    assert counts[1][EXECUTED, branch + 1] == most.bit_count()
