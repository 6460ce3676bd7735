"""Every bit of every word, and every cycle, against tables that are written by hand.

The assembler, the disassembler and both engines read the codes from one file, so that a code that
is wrong there is wrong everywhere: nothing that compares them would notice.
"""

from __future__ import annotations

import re
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import assemble_text, load_machine
from npchip.isa import load_isa
from tests.support.chips import chip_of, clip_of, machine_of, raw_chip

if TYPE_CHECKING:
    from collections.abc import Mapping

    from npchip.machine import Machine

FORMS = {
    "MOV D, S": "1011 dddd ssss 0000",
    "MOV D, #I": "0001 dddd iiii iiii",
    "LD D, [I]": "1001 dddd iiii iiii",
    "LD D, [S + B]": "1011 dddd ssss 10bb",
    "LD D, [S]": "1011 dddd ssss 1000",
    "ST [I], D": "1010 dddd iiii iiii",
    "ST [D + B], S": "1011 dddd ssss 11bb",
    "ST [D], S": "1011 dddd ssss 1100",
    "ADD D, S": "1011 dddd ssss 0001",
    "ADD D, #I": "0010 dddd iiii iiii",
    "ADC D, S": "1011 dddd ssss 0010",
    "ADC D, #I": "0011 dddd iiii iiii",
    "SUB D, S": "1011 dddd ssss 0011",
    "SUB D, #I": "0100 dddd iiii iiii",
    "SBC D, S": "1011 dddd ssss 0100",
    "SBC D, #I": "0101 dddd iiii iiii",
    "CMP D, S": "1011 dddd ssss 0101",
    "CMP D, #I": "0110 dddd iiii iiii",
    "AND D, S": "1011 dddd ssss 0110",
    "AND D, #I": "0111 dddd iiii iiii",
    "OR D, S": "1011 dddd ssss 0111",
    "OR D, #I": "1000 dddd iiii iiii",
    "SHL D, #K": "0000 dddd 0kkk 0001",
    "SHR D, #K": "0000 dddd 1kkk 0001",
    "RCR D": "0000 dddd 0000 0010",
    "NBR D, S, N": "0000 dddd ssss 01nn",
    "ROW D": "0000 dddd 0001 0010",
    "COL D": "0000 dddd 0010 0010",
    "WHERE C": "0000 0ccc 0000 1001",
    "ELSE": "0000 0000 0100 1010",
    "END": "0000 0000 0101 1010",
    "JMP T": "1110 000t tttt tttt",
    "JANY C, T": "1100 ccct tttt tttt",
    "JNONE C, T": "1101 ccct tttt tttt",
    "JALL O, T": "1101 ooot tttt tttt",
    "CALL T": "1110 001t tttt tttt",
    "RET": "0000 0000 0011 1010",
    "HALT": "0000 0000 0010 1010",
    "NOP": "0000 0000 0001 1010",
    "EXPOSE": "0000 0000 0110 1010",
    "SAMPLE L, B": "0000 00lb b000 1011",
    "OUT P, D": "0000 dddd pppp 1000",
    "IN D, P": "0000 dddd pppp 0011",
}
"""Bits of each way to write an instruction; capitals stand for operands."""
NUMBERS = {str(number): number for number in range(512)}
OPERANDS: dict[str, Mapping[str, int]] = {
    "D": {f"r{number}": number for number in range(16)},
    "S": {f"r{number}": number for number in range(16)},
    "I": dict(list(NUMBERS.items())[:256]),
    "K": dict(list(NUMBERS.items())[1:8]),
    "P": dict(list(NUMBERS.items())[:16]),
    "T": {name: number for name, number in NUMBERS.items() if number % 37 == 0 or number == 511},
    "B": {"0": 0, "64": 1, "128": 2, "192": 3},
    "C": {"EQ": 0, "NE": 1, "LO": 2, "CS": 2, "HS": 3, "CC": 3, "HI": 4, "LS": 5},
    "O": {"EQ": 1, "NE": 0, "LO": 3, "CS": 3, "HS": 2, "CC": 2, "HI": 5, "LS": 4},
    "N": {"north": 0, "east": 1, "south": 2, "west": 3},
    "L": {"reset": 0, "signal": 1},
}
"""Codes of the operands; of a large range those of some."""
PROGRAM = """\
        EXPOSE              ; control
        SAMPLE reset, 64    ; sample
        SAMPLE signal, 128  ; sample
        MOV r1, r2          ; move
        MOV r1, #3          ; move
        ROW r1              ; move
        COL r1              ; move
        LD r1, [5]          ; memory
        LD r1, [r2 + 64]    ; memory
        LD r1, [r2]         ; memory
        ST [5], r1          ; memory
        ST [r2 + 64], r1    ; memory
        ST [r2], r1         ; memory
        ADD r1, r2          ; alu
        ADD r1, #3          ; alu
        ADC r1, r2          ; alu
        ADC r1, #3          ; alu
        SUB r1, r2          ; alu
        SUB r1, #3          ; alu
        SBC r1, r2          ; alu
        SBC r1, #3          ; alu
        CMP r1, r2          ; alu
        CMP r1, #3          ; alu
        AND r1, r2          ; alu
        AND r1, #3          ; alu
        OR r1, r2           ; alu
        OR r1, #3           ; alu
        SHL r1, #1          ; alu
        SHR r1, #1          ; alu
        RCR r1              ; alu
        NBR r1, r2, north   ; neighbour
        NBR r1, r2, east    ; neighbour
        NBR r1, r2, south   ; neighbour
        NBR r1, r2, west    ; neighbour
        WHERE EQ            ; mask
        ELSE                ; mask
        END                 ; mask
        CALL sub            ; branch
        JMP over            ; branch
sub:    RET                 ; branch
over:   CMP r1, r1          ; alu
        JANY NE, over       ; global_or
        JANY EQ, here       ; global_or
here:   JNONE EQ, over      ; global_or
        JALL NE, over       ; global_or
        NOP                 ; control
        OUT 3, r1           ; output
        IN r1, 3            ; input
        HALT                ; control
"""
"""All instructions with their timing classes; each line is executed once."""
CLASSES = [line.split("; ")[1] for line in PROGRAM.splitlines()]
MNEMONICS = [re.sub(r"^\w+:", "", line).split()[0] for line in PROGRAM.splitlines()]


def bits(pattern: str, codes: Mapping[str, int]) -> int:
    """Fill the letters of a pattern with codes, the highest bit first."""
    text = pattern.replace(" ", "")
    for letter, code in codes.items():
        count = text.count(letter.lower())
        assert count
        assert code < 1 << count
        for bit in f"{code:0{count}b}":
            text = text.replace(letter.lower(), bit, 1)
    return int(text, 2)


def test_the_table_names_every_way_to_write_an_instruction() -> None:
    real = [form for item in load_isa().instructions.values() for form in item.forms]
    assert len(FORMS) == len(real)
    assert {name.split(maxsplit=1)[0] for name in FORMS} == set(load_isa().forms)


@pytest.mark.parametrize("form", FORMS)
def test_words_have_the_bits_of_the_table(form: str) -> None:
    """Each operand takes all its values, the others two each."""
    letters = [sign for sign in form[form.find(" ") :] if sign.isupper()] if " " in form else []
    cases = {
        combination
        for whole in letters
        for combination in product(
            *(OPERANDS[x] if x == whole else (*OPERANDS[x],)[1:4:2] or OPERANDS[x] for x in letters)
        )
    } or {()}
    written, wanted = [], []
    for case in sorted(cases):
        name, _, operands = form.partition(" ")
        for letter, value in zip(letters, case, strict=True):
            operands = operands.replace(letter, value, 1)
        codes = {x: OPERANDS[x][value] for x, value in zip(letters, case, strict=True)}
        written.append(f"{name} {operands}")
        wanted.append(bits(FORMS[form], codes))
    for at in range(0, len(written), 400):
        # Behind a HALT, so that masks and jumps do not matter.
        part = written[at : at + 400]
        padding = ["NOP"] * (511 - len(part))
        program = assemble_text("\n".join(["HALT", *part, *padding]))
        assert list(program.words[1 : 1 + len(part)]) == wanted[at : at + 400]


def test_directions_are_those_of_the_compass() -> None:
    """Row 0 lies in the north, column 0 in the west."""
    for code, (down, right) in enumerate(((-1, 0), (0, 1), (1, 0), (0, -1))):
        chip = raw_chip(0x0104 | 2 << 4 | code, bits(FORMS["HALT"], {}))
        rows, columns = np.indices(chip.machine.geometry)
        chip.registers[2] = 1 + 10 * rows + columns
        chip.run()
        padded = np.pad(1 + 10 * rows + columns, 1)
        height, width = chip.machine.geometry
        wanted = padded[1 + down : 1 + down + height, 1 + right : 1 + right + width]
        assert chip.registers[1].tolist() == wanted.tolist()


@pytest.mark.parametrize("code", range(6))
def test_conditions_hold_where_they_say(code: int) -> None:
    zero, carry = np.array([[False, False, True, True]]), np.array([[False, True, False, True]])
    holds = (zero, ~zero, carry, ~carry, ~carry & ~zero, carry | zero)[code]
    where = bits(FORMS["WHERE C"], {"C": code})
    chip = raw_chip(where, 0x1101, 0x005A, 0x002A, machine=machine_of(1, 4))
    chip.flags["Z"][:], chip.flags["C"][:] = zero, carry
    chip.run()
    assert chip.registers[1].tolist() == holds.astype(int).tolist()


def test_levels_and_banks_of_a_conversion() -> None:
    machine = machine_of(1, 1)
    clip = clip_of(1, machine)
    for level, bank in product(range(2), range(4)):
        sample = bits(FORMS["SAMPLE L, B"], {"L": level, "B": bank})
        chip = raw_chip(0x006A, sample, 0x002A, machine=machine)
        chip.run(clip)
        found = chip.memory[:, 0, 0].reshape(4, 64)
        assert found[bank].tolist() == (clip.ravel() * level).tolist()
        assert not np.delete(found, bank, axis=0).any()


def executed(machine: Machine) -> list[int]:
    """Cycles of each line of `PROGRAM` on a machine, as the chip counts them."""
    chip = chip_of(PROGRAM, machine)
    chip.connect(lambda _: np.zeros(machine.geometry, np.uint8))
    chip.feed(clip_of(1, machine))
    cycles = [0] * len(CLASSES)
    for _ in CLASSES:
        at, before = chip.pc, chip.cycles
        chip.step()
        cycles[at] = chip.cycles - before
    whole = chip_of(PROGRAM, machine, "wasm")
    whole.connect(lambda _: np.zeros(machine.geometry, np.uint8))
    assert whole.run(clip_of(1, machine)).cycles == chip.cycles == sum(cycles)
    return cycles


def test_each_instruction_takes_the_cycles_of_its_class() -> None:
    """On a machine on which each class takes another time."""
    timing = {name: 3 + 2 * place for place, name in enumerate(dict.fromkeys(CLASSES))}
    machine = machine_of(timing={**timing, "default": 1000})
    assert executed(machine) == [timing[name] for name in CLASSES]


def test_cycles_of_the_machine_that_results_are_quoted_for() -> None:
    """One for each instruction, but a conversion takes 256 and an output one a row of NPs."""
    special = {"sample": 256, "output": 8}
    assert executed(load_machine("default")) == [special.get(name, 1) for name in CLASSES]


def test_every_instruction_has_the_class_of_the_table() -> None:
    instructions = load_isa().instructions.values()
    assert dict(zip(MNEMONICS, CLASSES, strict=True)) == {
        form.mnemonic: item.timing for item in instructions for form in item.forms
    }
