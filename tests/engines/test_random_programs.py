"""Random straight programs on random registers against the array in plain integers."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.oracles.alu import REGISTERS, Array, Processor
from tests.support.chips import chip_of, machine_of

MACHINE = machine_of(3, 4)
POSITIONS = [(row, column) for row in range(3) for column in range(4)]

# Few registers, so that results are used again, and constants that often meet a limit.
registers = st.sampled_from(["r0", "r1", "r2", "r3", "r15"])
constants = st.one_of(st.integers(0, 255), st.sampled_from([0, 1, 127, 128, 255]))
two_operands = st.builds(
    "{} {}, {}".format,
    st.sampled_from(["MOV", "ADD", "ADC", "SUB", "SBC", "CMP", "AND", "OR"]),
    registers,
    st.one_of(registers, constants.map("#{}".format)),
)
shifts = st.builds(
    "{} {}, #{}".format, st.sampled_from(["SHL", "SHR"]), registers, st.integers(1, 7)
)
others = st.builds("{} {}".format, st.sampled_from(["RCR", "ROW", "COL"]), registers)
links = st.builds(
    "NBR {}, {}, {}".format,
    registers,
    registers,
    st.sampled_from(["north", "east", "south", "west"]),
)
addresses = st.one_of(
    constants.map(str),
    st.builds("{} + {}".format, registers, st.sampled_from([0, 64, 128, 192])),
)
moves = st.one_of(
    st.builds("LD {}, [{}]".format, registers, addresses),
    st.builds("ST [{}], {}".format, addresses, registers),
)
conditions = st.sampled_from(["EQ", "NE", "LO", "HS", "HI", "LS"])
instructions = st.one_of(two_operands, two_operands, shifts, others, links, moves)


@st.composite
def programs(draw: st.DrawFn) -> list[str]:
    """Lines with balanced masked regions, up to 15 deep, in which ELSE may come again."""
    lines: list[str] = []
    depth = 0
    steps = st.lists(st.sampled_from(["do", "do", "do", "WHERE", "ELSE", "END"]), max_size=40)
    for step in draw(steps):
        if step == "WHERE" and depth < MACHINE.mask_depth:
            lines.append(f"WHERE {draw(conditions)}")
            depth += 1
        elif step in {"ELSE", "END"} and depth > 0:
            lines.append(step)
            depth -= step == "END"
        else:
            lines.append(draw(instructions))
    return lines + ["END"] * depth


@given(lines=programs(), seed=st.integers(0, 2**32 - 1))
def test_program(lines: list[str], seed: int) -> None:
    rng = np.random.default_rng(seed)
    chip = chip_of("\n".join([*lines, "HALT"]), MACHINE)
    chip.registers[:] = rng.integers(0, 256, chip.registers.shape)
    chip.memory[:] = rng.integers(0, 256, chip.memory.shape)
    for flag in chip.flags.values():
        flag[:] = rng.integers(0, 2, flag.shape)
    array = Array(
        {
            (row, column): Processor(
                chip.registers[:, row, column].tolist(),
                bool(chip.flags["Z"][row, column]),
                bool(chip.flags["C"][row, column]),
                chip.memory[:, row, column].tolist(),
            )
            for row, column in POSITIONS
        }
    )
    for line in lines:
        array.execute(line)
        assert chip.step() is None
        for at in POSITIONS:
            own = array.processors[at]
            place = (slice(None), *at)
            assert chip.registers[place].tolist() == own.registers, line
            assert (chip.flags["Z"][at], chip.flags["C"][at]) == (own.z, own.c), line
            assert chip.active[at] == (at in array.active), line
    for at in POSITIONS:
        assert chip.memory[(slice(None), *at)].tolist() == array.processors[at].memory
    assert chip.cycles == chip.instructions == len(lines)
    assert len(chip.registers) == REGISTERS
