"""Reads of instructions from neighbours, against the reference engine."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

from npchip import Chip, Program, assemble_text, load_machine
from npchip.engines.base import TrapError
from npchip.isa import Form, Isa, load_isa, parse_isa
from npchip.language.moves import Move, moves
from npchip.studio.toolchain.described import described

ISA = load_isa()
ROWS, COLS = 8, 10
NEIGHBOURS = {"north": (-1, 0), "east": (0, 1), "south": (1, 0), "west": (0, -1)}
OWN = """
name: own
title: Two instructions of a user
word_bits: 16
operands:
  rd: {letter: d, kind: register, text: destination}
  rs: {letter: s, kind: register, text: source}
  direction:
    letter: n
    kind: choice
    choices: {north: 0, east: 1, south: 2, west: 3}
    text: a direction
  back:
    letter: m
    kind: choice
    choices: {north: 0, east: 1, south: 2, west: 3}
    text: another direction
conditions:
  EQ: {code: 0, when: Z, text: equal}
  NE: {code: 1, when: not Z, text: not equal}
instructions:
  - group: array
    name: BOTH
    title: Add two neighbours
    timing: alu
    forms:
      - {syntax: "BOTH {rd}, {rs}, {direction}, {back}", encoding: "0001 dddd ssss nnmm"}
    semantics: |
      rd = neighbour(rs, direction)
      rd = rd + neighbour(rs, back)
    text: Adds.
  - group: array
    name: DOUBLE
    title: Twice a neighbour
    timing: alu
    forms:
      - {syntax: "DOUBLE {rd}, {rs}, {direction}", encoding: "0010 dddd ssss 00nn"}
    semantics: rd = neighbour(rs + rs, direction)
    text: Doubles.
"""


def chip_of(word: int, isa: Isa = ISA) -> Chip:
    """A chip before a word, with another value in each NP and register."""
    chip = Chip(Program("one", (word,)), engine="reference", isa=isa)
    values = np.random.default_rng(1).permutation(256)[: ROWS * COLS].reshape(ROWS, COLS)
    for number in range(16):
        chip.registers[number] = np.roll(values, number)
    return chip


def word_of(form: Form, number: int = 0) -> int:
    """A word of a form; `number` chooses among registers and choices."""
    values: dict[str, int | str] = {}
    for at, slot in enumerate(form.slots.values()):
        kind = slot.operand.kind
        if kind == "register":
            values[slot.name] = (3 + at + number) % 16
        elif kind == "choice":
            values[slot.name] = list(slot.operand.choices)[number % len(slot.operand.choices)]
        elif kind == "condition":
            values[slot.name] = "EQ"
        else:
            values[slot.name] = slot.operand.least
    return ISA.encode(form, values)


@pytest.mark.parametrize("direction", NEIGHBOURS)
def test_each_np_takes_the_value_from_where_the_move_says(direction: str) -> None:
    (form,) = ISA.forms["NBR"]
    word = ISA.encode(form, {"rd": 5, "rs": 9, "direction": direction})
    decoded = ISA.decode(word)
    assert decoded is not None
    (move,) = moves(decoded)
    assert (move.row, move.column) == NEIGHBOURS[direction]
    assert move.register == 9
    chip = chip_of(word)
    source = chip.registers[move.register].copy()
    chip.step()
    for row in range(ROWS):
        for column in range(COLS):
            r, c = row + move.row, column + move.column
            inside = 0 <= r < ROWS and 0 <= c < COLS
            assert chip.registers[5][row, column] == (source[r, c] if inside else 0)


FORMS = [
    form
    for instruction in ISA.instructions.values()
    for form in instruction.forms
    if not form.alias and not form.inputs
]


@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.syntax)
def test_an_instruction_moves_something_if_one_np_can_change_another(
    form: Form, number: int
) -> None:
    word = word_of(form, number)
    decoded = ISA.decode(word)
    assert decoded is not None
    chips = [chip_of(word), chip_of(word)]
    chips[1].registers[:, 4, 5] ^= 0x5A
    for chip in chips:
        chip.feed(np.zeros((1, 64, 80), np.uint8))
        with suppress(TrapError):  # of RET, ELSE and END, where nothing is open
            chip.step()
    differ = (chips[0].registers != chips[1].registers).any(axis=0)
    differ[4, 5] = False
    found = {(int(row), int(column)) for row, column in np.argwhere(differ)}
    assert found == {(4 - move.row, 5 - move.column) for move in moves(decoded)}


def test_a_users_instruction_may_read_several_neighbours_or_work_the_value_out() -> None:
    isa = parse_isa(OWN, "own.yaml")
    (both,), (double,) = isa.forms["BOTH"], isa.forms["DOUBLE"]
    sides: dict[str, int | str] = {"direction": "north", "back": "west"}

    def found(form: Form, **values: int | str) -> tuple[Move, ...]:
        decoded = isa.decode(isa.encode(form, values))
        assert decoded is not None
        return moves(decoded)

    assert found(both, rd=1, rs=2, **sides) == (Move(-1, 0, 2), Move(0, -1, 2))
    # The first statement has overwritten r2, so that it no longer holds what it held before.
    assert found(both, rd=2, rs=2, **sides) == (Move(-1, 0, 2), Move(0, -1, None))
    assert found(double, rd=1, rs=2, direction="east") == (Move(0, 1, None),)


def test_the_page_gets_moves_with_the_words_that_have_them() -> None:
    program = assemble_text("ADD r0, r1\nNBR r5, r9, east\nHALT", "test.s")
    words = described(program, load_machine("default"), [], ISA)["words"]
    moved = {"row": 0, "column": 1, "register": 9}
    assert [word.get("moves") for word in words] == [None, [moved], None]
