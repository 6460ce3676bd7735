"""Registers for straight code."""

from __future__ import annotations

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.kernels.code import Code, NoRoomError


def sums_of_numbers(count: int) -> Code:
    """Code that makes the numbers 1, 2, 3 ... and only then adds them up and sends the sum."""
    code = Code("place")
    values = [code.new() for _ in range(count)]
    for number, value in enumerate(values, 1):
        code.add(f"MOV {{0}}, #{number}", value, made=[value])
    total = values[0]
    for value in values[1:]:
        code.add("ADD {0}, {1}", total, value, changed=[total])
    code.add("OUT 0, {0}", total)
    return code


@pytest.mark.parametrize("registers", [2, 3, 5, 9])
def test_values_wait_in_memory_where_registers_are_few(registers: int) -> None:
    lines = sums_of_numbers(9).lines([f"r{number}" for number in range(registers)], range(100, 109))
    program = assemble_text("\n".join([".output sum, 0, plane", "EXPOSE", *lines, "HALT"]))
    result = Chip(program, engine="reference").run(np.zeros((1, 64, 80), np.uint8))
    assert (result.outputs["sum"] == sum(range(1, 10))).all()
    assert any("ST" in text for text in lines) == (registers < 9)


def test_too_little_memory_is_noticed() -> None:
    with pytest.raises(NoRoomError):
        sums_of_numbers(9).lines(["r0", "r1"], range(3))


def test_the_pointer_moves_only_where_no_bank_helps() -> None:
    code = Code("place")
    assert code.address(128, 0) == "[place + 128]"
    assert code.address(8 + 64, 64) == "[place + 64]"
    assert code.address(8, 0) == "[place]"
    assert [step.lines for step in code.steps] == [("ADD place, #8",)]
