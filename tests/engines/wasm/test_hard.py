"""The programs of the benchmarks that are made to take long to compile."""

from __future__ import annotations

import pytest

from benchmarks.hard import PROGRAMS
from npchip import Chip, load_machine
from tests.support.lockstep import assert_engines_agree
from tests.support.random_cases import Case


@pytest.mark.long
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_that_takes_long_to_compile(name: str) -> None:
    text = f"{PROGRAMS[name]}\n"
    case = Case(text, load_machine("default"), 0, 1, 1_000_000, again=False, partner="sends")
    (result,) = assert_engines_agree(case)
    assert result.status == ("frames-exhausted" if name == "500 exposes" else "halted")
    assert len(case.program().words) <= 512
    chip = Chip(case.program())
    chip.connect(lambda _: chip.registers[0])
    assert chip.run(case.clip()).engine == "wasm" or chip.notice
