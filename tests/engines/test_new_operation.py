"""An operation that only the recipe of docs/contributing.md adds; everything else lives with it."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.base.errors import IsaError
from npchip.debugger.values import Cell, Writers
from npchip.engines.reference import lowering
from npchip.engines.reference.lowering import Evaluate
from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.values import Value
from npchip.isa import Isa, ir, parse_isa
from npchip.isa.ir import Signature, Type
from npchip.program import bits
from npchip.program.bounds import static_view
from npchip.program.known import Transfer, after_reset
from npchip.program.reads import reads_and_writes
from tests.support.chips import machine_of, places

ENTRY = """extends: npchip
name: ones
instructions:
  - group: arithmetic
    name: ONES
    title: Count ones
    timing: alu
    forms: [{{syntax: "ONES {{rd}}, {{rs}}", encoding: "1111 dddd ssss 0000"}}]
    semantics: |
      {semantics}
    text: Of a test.
"""
SOURCE = """
        MOV  r1, #3
loop:   ONES r2, r4
        ADD  r4, r2
        SUB  r1, #1
        JANY NE, loop
        ONES r5, r1
        JANY NE, done       ; nothing is known of r5
        NOP
done:   HALT
"""


ENGINES: tuple[Literal["reference", "wasm"], ...] = ("reference", "wasm")


def ones_of_array(value: Evaluate) -> Evaluate:
    return lambda: np.unpackbits(value()[..., None], axis=-1).sum(-1, dtype=np.uint8)


def ones_of_value(values: ValueBuilder, value: Value) -> Value:
    found = values.constant(0)
    for index in range(8):
        found = values.add(found, values.byte(values.bit(value, index)))
    return found


@pytest.fixture
def isa(monkeypatch: pytest.MonkeyPatch) -> Isa:
    """An instruction set with ``ones(byte)``, known to the language and to both engines."""
    signature = Signature((Type.BYTE,), Type.BYTE)
    monkeypatch.setitem(ir.FUNCTIONS, "ones", signature)
    monkeypatch.setitem(ir.OPERATIONS, "ones", signature)
    monkeypatch.setitem(lowering.OPERATIONS, "ones", ones_of_array)
    before = ValueBuilder.operations
    monkeypatch.setattr(
        ValueBuilder,
        "operations",
        lambda self: before(self) | {"ones": lambda value: ones_of_value(self, value)},
    )
    return parse_isa(ENTRY.format(semantics="rd = ones(rs)\n      Z = rd == 0"), "ones.yaml")


def test_both_engines_execute_it(isa: Isa) -> None:
    machine = machine_of(16, 16)
    rows, columns = places(machine)
    start = rows * 16 + columns
    expected = start.copy()
    for _ in range(3):
        count = np.unpackbits(expected[..., None], axis=-1).sum(-1, dtype=np.uint8)
        expected += count
    program = assemble_text(SOURCE, machine=machine, isa=isa)
    for engine in ENGINES:
        chip = Chip(program, machine, isa=isa, engine=engine)
        chip.registers[4] = start
        chip.run()
        np.testing.assert_array_equal(chip.registers[2], count)
        np.testing.assert_array_equal(chip.registers[4], expected)


def test_known_bits_are_none_of_its_result_and_all_of_the_rest(isa: Isa) -> None:
    decoded = isa.decode(0xF240)
    assert decoded is not None
    before = after_reset()
    known, _ = Transfer(decoded, isa).apply(before, 0)
    changed = {variable for variable, _ in before if known[variable, 0] != before[variable, 0]}
    assert changed == {2, ir.ZERO}
    assert known[2, 0] == bits.UNKNOWN


def test_the_bounds_hold(isa: Isa) -> None:
    machine = machine_of(2, 2)
    program = assemble_text(SOURCE, machine=machine, isa=isa)
    chip = Chip(program, machine, isa=isa)
    chip.run()
    setup = static_view(program, machine, isa).setup
    assert setup is not None
    assert setup.most == chip.cycles  # the loop is counted through
    assert setup.least == setup.most - 1  # either way of the second branch


def test_it_reads_what_its_arguments_read(isa: Isa) -> None:
    decoded = isa.decode(0xF240)
    assert decoded is not None
    assert reads_and_writes(decoded, isa) == (1 << 4, 1 << 2 | 1 << ir.ZERO)


def test_devices_are_checked_inside_it(isa: Isa) -> None:
    assert isa.instructions["ONES"].flags == ("Z",)
    with pytest.raises(IsaError, match=r"input\(\) takes a port, 0 to 15; this may be 16"):
        parse_isa(ENTRY.format(semantics="rd = ones(input(16))"), "ones.yaml")
    with pytest.raises(IsaError, match=r"ones\(\) takes 1 arguments, found 2"):
        parse_isa(ENTRY.format(semantics="rd = ones(rd, rs)"), "ones.yaml")


def test_the_debugger_knows_what_it_writes(isa: Isa) -> None:
    writers = Writers(assemble_text(SOURCE, machine=machine_of(), isa=isa), isa)
    assert writers.of(Cell("register", 2)) == {1}
    assert writers.of(Cell("register", 5)) == {5}
    assert writers.of(Cell("flag", "Z")) == {1, 2, 3, 5}
