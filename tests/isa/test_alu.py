"""Every ALU instruction on all operands and flags against plain-integer arithmetic.

In the wide array the row number is one operand and the column number the other, so that one
instruction meets all 65,536 pairs. In the flat array the row number is the state of the flags
and the column number the only operand.
"""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.oracles.alu import alu, condition
from tests.support.chips import chip_of, machine_of, places

if TYPE_CHECKING:
    from collections.abc import Sequence

    from npchip import Chip
    from tests.support.chips import Bits, Bytes

TWO_OPERANDS = ("MOV", "ADD", "ADC", "SUB", "SBC", "CMP", "AND", "OR")
SOME = (*range(0, 256, 17), 1, 127, 128, 254)
FLAG_STATES = tuple(product((False, True), repeat=2))
WIDE = machine_of(256, 256, memory_bytes=64)
FLAT = machine_of(4, 256, memory_bytes=64)
RELATIONS = {"EQ": "__eq__", "NE": "__ne__", "LO": "__lt__"} | {
    "HS": "__ge__",
    "HI": "__gt__",
    "LS": "__le__",
}


@cache
def wide_table(name: str, z: bool, c: bool) -> tuple[Bytes, Bits, Bits]:
    """Return result, Z and C of the oracle for all pairs, shape (256, 256)."""
    return _arrays([alu(name, a, b, z, c) for a in range(256) for b in range(256)], 256)


def flat_table(name: str, other: int | None) -> tuple[Bytes, Bits, Bits]:
    """Return the oracle's results for all flags and registers; `other` None: the same register."""
    results = [
        alu(name, a, a if other is None else other, z, c)
        for z, c in FLAG_STATES
        for a in range(256)
    ]
    return _arrays(results, 4)


def _arrays(results: list[tuple[int, bool, bool]], rows: int) -> tuple[Bytes, Bits, Bits]:
    value, zero, carry = zip(*results, strict=True)
    return (
        np.array(value, np.uint8).reshape(rows, -1),
        np.array(zero, np.bool_).reshape(rows, -1),
        np.array(carry, np.bool_).reshape(rows, -1),
    )


def set_up(chip: Chip, a: Bytes, b: Bytes, z: Bits | bool, c: Bits | bool) -> None:
    """r5 becomes a and r9 becomes b; every other register has a value of its own."""
    chip.registers[:] = np.arange(100, 116, dtype=np.uint8)[:, None, None]
    chip.registers[5], chip.registers[9] = a, b
    chip.flags["Z"][:], chip.flags["C"][:] = z, c


def check(chip: Chip, expected: tuple[Bytes, Bits, Bits]) -> None:
    """Execute one instruction; r5 and the flags become what is expected, all else stays.

    NPs that are not active must keep everything.
    """
    active = chip.active
    registers, z, c = chip.registers.copy(), chip.flags["Z"].copy(), chip.flags["C"].copy()
    registers[5][active] = expected[0][active]
    z[active], c[active] = expected[1][active], expected[2][active]
    assert chip.step() is None
    assert np.array_equal(chip.registers, registers)
    assert np.array_equal(chip.flags["Z"], z)
    assert np.array_equal(chip.flags["C"], c)
    assert np.array_equal(chip.active, active)
    assert not chip.memory.any()


def mask_every_third(chip: Chip) -> None:
    """Execute a ``WHERE EQ`` that only every third NP survives."""
    zero = chip.flags["Z"]
    zero[:] = np.arange(zero.size).reshape(zero.shape) % 3 == 0
    chip.step()
    assert np.array_equal(chip.active, zero)


@pytest.mark.parametrize(
    "name",
    [
        name if name in {"ADC", "SBC", "CMP"} else pytest.param(name, marks=pytest.mark.long)
        for name in TWO_OPERANDS
    ],
)
def test_registers(name: str) -> None:
    operation = f"{name} r5, r9\n" * 4
    chip = chip_of(f"{operation}WHERE EQ\n{operation}END\nHALT", WIDE)
    a, b = places(WIDE)
    for masked in (False, True):
        if masked:
            mask_every_third(chip)
        for z, c in FLAG_STATES:
            set_up(chip, a, b, z, c)
            check(chip, wide_table(name, z, c))
    assert chip.instructions == 9


@pytest.mark.parametrize("numbers", [SOME, pytest.param(range(256), marks=pytest.mark.long)])
@pytest.mark.parametrize("name", TWO_OPERANDS)
def test_constants(name: str, numbers: Sequence[int]) -> None:
    chip = chip_of("".join(f"{name} r5, #{n}\n" for n in numbers), FLAT)
    flags, a = places(FLAT)
    for number in numbers:
        set_up(chip, a, a, flags >= 2, flags % 2 == 1)
        check(chip, flat_table(name, number))


@pytest.mark.parametrize(
    ("name", "other"),
    [(name, count) for name in ("SHL", "SHR") for count in range(1, 8)]
    + [("RCR", 0), ("AND", 0x55), ("SBC", 200)]
    + [(name, None) for name in TWO_OPERANDS],
)
def test_one_operand_and_masks(name: str, other: int | None) -> None:
    """Shifts, some constants, and both operands in the same register; in two masks too."""
    operand = {"RCR": ""}.get(name, ", r5" if other is None else f", #{other}")
    operation = f"{name} r5{operand}\n"
    chip = chip_of(f"{operation}WHERE EQ\n{operation}ELSE\n{operation}END\n{operation}HALT", FLAT)
    flags, a = places(FLAT)
    expected = flat_table(name, other)
    for region in ("none", "WHERE", "ELSE", "closed"):
        if region == "WHERE":
            mask_every_third(chip)
        elif region != "none":
            chip.step()
        set_up(chip, a, a, flags >= 2, flags % 2 == 1)
        check(chip, expected)
    assert chip.active.all()


@pytest.mark.parametrize("name", RELATIONS)
def test_conditions_after_compare_and_subtract(name: str) -> None:
    source = f"CMP r5, r9\nWHERE {name}\nEND\nSUB r5, r9\nWHERE {name}\nEND\nHALT"
    chip = chip_of(source, WIDE)
    a, b = places(WIDE)
    relation = np.array(
        [[getattr(row, RELATIONS[name])(k) for k in range(256)] for row in range(256)]
    )
    set_up(chip, a, b, z=False, c=False)
    for _ in range(2):
        chip.step()
        chip.step()
        assert np.array_equal(chip.active, relation)
        chip.step()


@pytest.mark.parametrize("alias", ["CS LO", "CC HS"])
@pytest.mark.parametrize("name", ["", *RELATIONS])
def test_conditions_on_flags(name: str, alias: str) -> None:
    written, meant = (name, name) if name else tuple(alias.split())
    chip = chip_of(f"WHERE {written}\nEND\nHALT", machine_of(2, 2))
    z, c = places(chip.machine)
    chip.flags["Z"][:], chip.flags["C"][:] = z, c
    chip.step()
    expected = [[condition(meant, bool(z), bool(c)) for c in range(2)] for z in range(2)]
    assert chip.active.tolist() == expected
    assert chip.flags["Z"].tolist() == z.tolist()
    assert chip.flags["C"].tolist() == c.tolist()


def test_sixteen_bit_values() -> None:
    """Carry chains give sums, differences, means and tests for zero of 16 bits."""
    chip = chip_of(
        """
        ADD r0, r2
        ADC r1, r3
        SUB r4, r2
        SBC r5, r3
        SHR r7, #1
        RCR r6
        HALT
        """,
        machine_of(16, 16, memory_bytes=64),
    )
    draw = np.random.default_rng(3).integers(0, 65536, (2, 16, 16))
    draw[0, :4], draw[1, :2] = draw[1, :4], 0
    draw[0, 4:6] = 65536 - draw[1, 4:6]
    for low, number in ((0, draw[0]), (2, draw[1]), (4, draw[0]), (6, draw[0])):
        chip.registers[low], chip.registers[low + 1] = number % 256, number // 256 % 256

    def wide(low: int) -> list[list[int]]:
        values: list[list[int]] = (
            chip.registers[low] + 256 * chip.registers[low + 1].astype(int)
        ).tolist()
        return values

    left, right = (plane.tolist() for plane in draw)
    pairs = [
        [(x % 65536, y) for x, y in zip(*rows, strict=True)]
        for rows in zip(left, right, strict=True)
    ]
    chip.step()
    chip.step()
    assert wide(0) == [[(x + y) % 65536 for x, y in row] for row in pairs]
    assert chip.flags["C"].tolist() == [[x + y > 65535 for x, y in row] for row in pairs]
    assert chip.flags["Z"].tolist() == [[(x + y) % 65536 == 0 for x, y in row] for row in pairs]
    chip.step()
    chip.step()
    assert wide(4) == [[(x - y) % 65536 for x, y in row] for row in pairs]
    assert chip.flags["C"].tolist() == [[x < y for x, y in row] for row in pairs]
    assert chip.flags["Z"].tolist() == [[x == y for x, y in row] for row in pairs]
    chip.step()
    chip.step()
    assert wide(6) == [[x // 2 for x, _ in row] for row in pairs]
