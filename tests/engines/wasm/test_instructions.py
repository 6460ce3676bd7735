"""Every form of every instruction, alone, on both engines: all operands and all flags.

An array of 32 × 32 NPs holds all values of a byte under each of the four states of the flags; a
second operand takes every value in turn. Forms come from the instruction-set file.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import Chip, Program, load_machine
from npchip.isa import load_isa
from tests.support.lockstep import result_difference, state, state_difference
from tests.support.profiles import THOROUGH

if TYPE_CHECKING:
    from collections.abc import Sequence

    from npchip.isa.model import FieldValue, Form, Slot

MACHINE = replace(load_machine("default"), name="wide", np_rows=32, np_cols=32)
ISA = load_isa()
FORMS = [form for item in ISA.instructions.values() for form in item.forms if not form.alias]
FEW = (0, 1, 127, 128, 255)
MANY = range(256) if THOROUGH else (*range(0, 256, 37), 1, 63, 127, 128, 254, 255)
"""Values of a second register, and of numbers in an instruction."""


def choices(slot: Slot, numbers: Sequence[int]) -> list[FieldValue]:
    """Values of an operand that are tried."""
    operand = slot.operand
    match operand.kind:
        case "register":
            return [1] if slot.name == "rd" else [1, 2]
        case "condition":
            return list(ISA.conditions)
        case "choice":
            return list(operand.choices)
        case "label":
            return [0, 1, 2]
    steps = range(operand.least, operand.most + 1, operand.step)
    return [number for number in steps if len(steps) <= 8 or number in numbers]


def words(form: Form, numbers: Sequence[int]) -> list[int]:
    """Every word of a form that is tried."""
    combinations: list[dict[str, FieldValue]] = [{}]
    for slot in form.slots.values():
        combinations = [c | {slot.name: v} for c in combinations for v in choices(slot, numbers)]
    return [ISA.encode(form, values) for values in combinations]


def prepare(chip: Chip, other: int, *, uniform: bool) -> None:
    """All bytes and flags in the lanes of r1; `other` in r2, or everything the same everywhere."""
    chip.reset()
    lanes = np.arange(1024).reshape(32, 32)
    chip.registers[1] = (other * 7 & 255) if uniform else lanes & 255
    chip.registers[2] = other
    chip.flags["Z"][...] = bool(other & 1) if uniform else lanes >> 8 & 1
    chip.flags["C"][...] = bool(other & 2) if uniform else lanes >> 9 & 1
    chip.memory[...] = np.random.default_rng(other).integers(0, 256, chip.memory.shape, np.uint8)


@pytest.mark.parametrize("values", [FEW, pytest.param(MANY, marks=pytest.mark.long)])
@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.syntax)
def test_instruction(form: Form, values: Sequence[int]) -> None:
    halt = next(f for f in FORMS if set(f.effects) == {"halt"})
    end = ISA.encode(halt, {})
    two = sum(slot.operand.kind == "register" for slot in form.slots.values()) > 1
    clip = np.random.default_rng(3).integers(0, 256, (2, 256, 256), np.uint8)
    for word in words(form, values):
        program = Program("one", (word, end, end))
        slow, fast = Chip(program, MACHINE, "reference"), Chip(program, MACHINE, "wasm")
        for uniform in (False, True):
            for other in values if two or uniform else (5,):
                for chip in (slow, fast):
                    prepare(chip, other, uniform=uniform)
                expected, found = (chip.run(clip, max_cycles=600) for chip in (slow, fast))
                where = f"word 0x{word:04X} with {other}"
                assert not result_difference(expected, found), where
                assert not state_difference(state(slow), state(fast)), where
