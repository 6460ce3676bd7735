"""Loops whose passes the compiled engine counts beforehand: their passes are code of their own."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.engines.wasm.translate.trip_count import known_bits, operands
from npchip.engines.wasm.translate.values import VARYING, Value
from npchip.program import bits
from tests.engines.wasm.test_engine import both
from tests.engines.wasm.test_values import EXPRESSIONS, Expressions
from tests.support.chips import machine_of
from tests.support.compiled import compiled

MACHINE = machine_of()

SENTINEL = """
        MOV r1, #1
loop:   LD  r2, [r0 + 64]
        ADD r0, #1
        CMP r2, #40
        ADC r1, r1
        JNONE CS, loop
        HALT
"""
LONG = "MOV r1, #0\nl: ADD r2, r1\nADD r1, #1\nCMP r1, #64\nJANY LO, l\nHALT"
COUNTED = {
    "down": "MOV r1, #7\nl: ADD r2, #1\nSUB r1, #1\nJANY NE, l\nHALT",
    "up": LONG.replace("64", "9"),
    "by three": "MOV r1, #250\nl: LD r3, [r2 + 0]\nADD r1, #3\nJNONE CS, l\nHALT",
    "once": "MOV r1, #1\nl: COL r3\nSUB r1, #1\nJANY NE, l\nHALT",
    "sentinel to the left": SENTINEL,
    "sentinel to the right": (
        "MOV r1, #0x80\nl: LD r2, [r3 + 0]\nCMP r2, r4\nRCR r1\nJNONE CS, l\nHALT"
    ),
    "shifted": "MOV r1, #4\nl: COL r2\nSHL r1, #1\nJNONE CS, l\nHALT",
    "of all NPs": "MOV r1, #5\nl: ROW r2\nSUB r1, #1\nCMP r1, #2\nJNONE EQ, l\nHALT",
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


@pytest.mark.parametrize("source", COUNTED.values(), ids=COUNTED)
def test_every_pass_of_a_counted_loop_is_code_of_its_own(source: str) -> None:
    chip = Chip(assemble_text(source, "test.s", MACHINE), MACHINE, "reference")
    made = compiled(source, MACHINE)
    assert made.instructions == chip.run().instructions
    assert not made.branches


def test_the_passes_of_a_long_loop_are_code_sixteen_at_a_time() -> None:
    made = compiled(LONG, MACHINE)
    assert made.blocks == (1, 16 * 4, 1)  # with the branch that remains
    assert made.loops == 1


@pytest.mark.parametrize(("passes", "at_a_time"), [(82, 2), (129, 3), (170, 10), (83, 1)])
def test_the_passes_of_a_long_loop_are_code_as_many_at_a_time_as_divide_them(
    passes: int, at_a_time: int
) -> None:
    made = compiled(LONG.replace("64", str(passes)), MACHINE)
    assert made.blocks == (1, at_a_time * 4, 1)
    assert made.loops == 1


@pytest.mark.parametrize("source", UNKNOWN.values(), ids=UNKNOWN)
def test_any_other_loop_stays_as_it_is(source: str) -> None:
    words = assemble_text(source, "test.s", MACHINE).words
    made = compiled(source, MACHINE)
    assert made.loops
    assert made.instructions == len(words)


@pytest.mark.parametrize("source", [LONG, *COUNTED.values(), *UNKNOWN.values()])
def test_unrolled_loops_do_the_same(source: str) -> None:
    if "IN " not in source:  # see tests/engines/test_inputs.py
        both(source, frames=4, limit=3000)


def test_a_loop_around_a_counted_loop_stays_a_loop() -> None:
    """It is one block as well, but too long for copies."""
    around = SENTINEL.replace("        MOV r1", "        MOV r5, #1\nrow: MOV r1").replace(
        "        HALT", "ADC r5, r5\nJNONE CS, row\nHALT"
    )
    made = compiled(around, MACHINE)
    assert made.blocks == (1, 1 + 8 * 5 + 2, 1)
    assert made.loops == 1


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
    """Return the known bits of a node, whose operands are looked at first."""
    if node not in table:
        for arg in operands(node):
            said_of(arg, table, now)
        table[node] = known_bits(node, table, now)
    return table[node]
