"""Loops whose passes the compiled engine counts beforehand: which, how often, and what it knows."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

import numpy as np
import pytest

from npchip import assemble_text
from npchip.engines.wasm.translate.analysis import uniformity
from npchip.engines.wasm.translate.block import Executor
from npchip.engines.wasm.translate.graph import build
from npchip.engines.wasm.translate.steps import Block
from npchip.engines.wasm.translate.summary import SAME
from npchip.engines.wasm.translate.trip_count import known_bits, operands, trip_count
from npchip.engines.wasm.translate.unroll import unroll
from npchip.engines.wasm.translate.values import VARYING, Value
from npchip.engines.wasm.translation import translate
from npchip.isa import load_isa
from npchip.program import bits
from npchip.program.graph import Place
from tests.engines.wasm.test_engine import both
from tests.engines.wasm.test_values import EXPRESSIONS, Expressions
from tests.support.chips import machine_of

MACHINE = machine_of()
BEGIN = dict.fromkeys(range(18), SAME)

SENTINEL = """
        MOV r1, #1
loop:   LD  r2, [r0 + 64]
        ADD r0, #1
        CMP r2, #40
        ADC r1, r1
        JNONE CS, loop
        HALT
"""
COUNTED = {
    "down": ("MOV r1, #7\nl: ADD r2, #1\nSUB r1, #1\nJANY NE, l\nHALT", 7),
    "up": ("MOV r1, #0\nl: ADD r2, r1\nADD r1, #1\nCMP r1, #64\nJANY LO, l\nHALT", 64),
    "by three": ("MOV r1, #250\nl: LD r3, [r2 + 0]\nADD r1, #3\nJNONE CS, l\nHALT", 2),
    "once": ("MOV r1, #1\nl: COL r3\nSUB r1, #1\nJANY NE, l\nHALT", 1),
    "sentinel to the left": (SENTINEL, 8),
    "sentinel to the right": (
        "MOV r1, #0x80\nl: LD r2, [r3 + 0]\nCMP r2, r4\nRCR r1\nJNONE CS, l\nHALT",
        8,
    ),
    "shifted": ("MOV r1, #4\nl: COL r2\nSHL r1, #1\nJNONE CS, l\nHALT", 6),
    "of all NPs": ("MOV r1, #5\nl: ROW r2\nSUB r1, #1\nCMP r1, #2\nJNONE EQ, l\nHALT", 3),
}
UNKNOWN = {
    "a byte counts": "LD r1, [3]\nl: SUB r1, #1\nJANY NE, l\nHALT",
    "each NP counts": "COL r1\nl: ADD r1, #1\nCMP r1, #200\nJANY LO, l\nHALT",
    "masked": "COL r2\nCMP r2, #1\nMOV r1, #3\nWHERE EQ\nl: SUB r1, #1\nJANY NE, l\nEND\nHALT",
    "two beginnings": (
        "MOV r1, #3\nCMP r2, r3\nJANY EQ, l\nMOV r1, #4\nl: SUB r1, #1\nJANY NE, l\nHALT"
    ),
    "endless": "MOV r1, #1\nl: ADD r1, #2\nJANY NE, l\nHALT",
    "frames": "MOV r1, #3\nl: EXPOSE\nSUB r1, #1\nJANY NE, l\nHALT",
    "inputs": "MOV r1, #3\nl: IN r2, 0\nSUB r1, #1\nJANY NE, l\nHALT",
}


def blocks_of(source: str) -> tuple[list[Block], Sequence[int | None]]:
    """The blocks of a source, and how often each is passed."""
    isa = load_isa()
    blocks = build(assemble_text(source, "test.s", MACHINE), MACHINE, isa, Place(0), 999)
    claims = uniformity(blocks, Executor(isa, MACHINE.memory_bytes), BEGIN)
    found = [trip_count(block, claims) for block in blocks]
    return blocks, [None if item is None else item.times for item in found]


@pytest.mark.parametrize("name", COUNTED)
def test_passes_that_are_known(name: str) -> None:
    source, times = COUNTED[name]
    _, found = blocks_of(source)
    assert [item for item in found if item is not None] == [times]


@pytest.mark.parametrize("name", UNKNOWN)
def test_passes_that_are_not(name: str) -> None:
    blocks, found = blocks_of(UNKNOWN[name])
    assert any(block.number in block.after for block in blocks)
    assert set(found) == {None}


@pytest.mark.parametrize("source", [*(source for source, _ in COUNTED.values()), *UNKNOWN.values()])
def test_unrolled_loops_do_the_same(source: str) -> None:
    if "IN " not in source:  # see test_input.py
        both(source, frames=4, limit=3000)


def steps_of(source: str) -> list[int]:
    """Steps of each block as it is compiled."""
    program = assemble_text(source, "test.s", MACHINE)
    blocks = translate(program, MACHINE, load_isa(), Place(0), BEGIN).blocks
    return [len(block.steps) for block in blocks]


def test_what_becomes_of_a_loop() -> None:
    # All passes with what comes before them; the halt leaves.
    assert steps_of(SENTINEL) == [1 + 8 * 5, 1]
    # 64 passes of 4 steps are too many: 16 at a time, with the branch that remains.
    assert steps_of(COUNTED["up"][0]) == [1, 16 * 4, 1]
    # The loop around is then one block as well, but too long.
    around = SENTINEL.replace("        MOV r1", "        MOV r5, #1\nrow: MOV r1").replace(
        "        HALT", "ADC r5, r5\nJNONE CS, row\nHALT"
    )
    assert steps_of(around) == [1, 1 + 8 * 5 + 2, 1]


def test_a_loop_without_passes_that_are_known_stays_as_it_is() -> None:
    isa = load_isa()
    for source in UNKNOWN.values():
        blocks = build(assemble_text(source, "test.s", MACHINE), MACHINE, isa, Place(0), 999)
        assert unroll(blocks, uniformity(blocks, Executor(isa, 256), BEGIN), 999) is None


def test_addresses_that_cannot_wrap_are_known() -> None:
    source = SENTINEL.replace("        MOV r1", "        MOV r0, #8\nMOV r1")
    isa = load_isa()
    blocks = build(assemble_text(source, "test.s", MACHINE), MACHINE, isa, Place(0), 999)
    claims = uniformity(blocks, Executor(isa, MACHINE.memory_bytes), BEGIN)
    (found,) = [item for item in (trip_count(block, claims) for block in blocks) if item]
    assert found.most[0] == 15


def test_addresses_that_wrap_in_a_loop_do() -> None:
    # From 250 on, eight passes: the addresses 250 to 255 and 0 to 1, and 64 more.
    source = SENTINEL.replace("        MOV r1", "        MOV r0, #250\nMOV r1")
    both("COL r3\nROW r4\nADD r3, r4\nST [60], r3\nST [1], r4\n" + source)


@pytest.mark.parametrize("share", range(4))
def test_bits_that_are_said_to_be_known_are(share: int) -> None:
    told = 0
    for seed in range(share * EXPRESSIONS, (share + 1) * EXPRESSIONS):
        made = Expressions(Random(seed))
        now = {}
        for variable, lanes in enumerate(made.leaves):  # bits that are the same everywhere
            ones, zeros = np.bitwise_and.reduce(lanes), np.bitwise_and.reduce(255 - lanes)
            now[variable] = (int(ones | zeros), int(ones))
        for _ in range(12):
            made.grow()
        table: dict[Value, bits.Bits] = {}
        for node, lanes in made.bytes + made.bits:
            known, value = said_of(node, table, now)
            top = 255 if any(node is item for item, _ in made.bytes) else 1
            assert ((lanes & known & top) == (value & top)).all(), f"seed {seed}: {node.op}"
            told += node.kind == VARYING and known & top != 0
    assert told > EXPRESSIONS // 4


def said_of(node: Value, table: dict[Value, bits.Bits], now: dict[int, bits.Bits]) -> bits.Bits:
    """What is said of a node, whose operands are looked at first."""
    if node not in table:
        for arg in operands(node):
            said_of(arg, table, now)
        table[node] = known_bits(node, table, now)
    return table[node]
