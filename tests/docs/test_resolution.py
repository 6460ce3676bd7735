"""docs/resolution.md: processing takes as many cycles on every array, read-out a cycle a row."""

from __future__ import annotations

import numpy as np
import pytest

from examples.measure import ROOT
from npchip import Chip, assemble
from tests.support.chips import machine_of

PAGE = (ROOT / "docs" / "resolution.md").read_text(encoding="utf-8")
ARRAYS = ((8, 10), (16, 20), (32, 32))
ROWS = {
    cells[0].strip("`"): [int(cell.replace(",", "")) for cell in cells[1:]]
    for line in PAGE.splitlines()
    if line.startswith("| `") and len(cells := line.strip("| ").split(" | ")) == 5
}


@pytest.mark.long
@pytest.mark.parametrize("name", ROWS)
def test_cycles_of_processing_are_the_same_on_every_array(name: str) -> None:
    processing, *readout = ROWS[name]
    for (rows, cols), expected in zip(ARRAYS, readout, strict=True):
        machine = machine_of(rows, cols)
        program = assemble(ROOT / "asm" / name, machine=machine)
        chip = Chip(program, machine)
        frames = np.random.default_rng(3).integers(0, 256, (2, machine.rows, machine.cols))
        result = chip.run(frames)
        sends = sum(
            count
            for count, word in zip(chip.executions, program.decoded(chip.isa), strict=True)
            if word is not None and word.form.instruction == "OUT"
        )
        assert sends * rows == expected * result.frames
        assert result.frame_cycles.tolist() == [processing + expected] * 2


def test_the_page_has_seven_programs() -> None:
    assert len(ROWS) == 7
