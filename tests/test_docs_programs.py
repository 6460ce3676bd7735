"""docs/programs.md and docs/programming.md: their figures are those of runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from examples import programs_page
from examples.measure import SETTINGS
from npchip import assemble

ROOT = Path(__file__).parents[1]
ASM = ROOT / "asm"


def test_every_program_has_its_place() -> None:
    assert set(SETTINGS) == {path.stem for path in ASM.glob("*.s")}


def test_the_table_of_programs_is_what_its_script_measures() -> None:
    page = (ROOT / "docs" / "programs.md").read_text(encoding="utf-8")
    assert page == programs_page.document(), "python -m examples.programs_page writes it"


@pytest.mark.parametrize("name", SETTINGS)
def test_a_head_states_all_outputs_and_constants(name: str) -> None:
    program = assemble(ASM / f"{name}.s")
    outputs = list(programs_page.entries(name, "Output"))
    assert [(entry.name, entry.kind) for entry in outputs] == [
        (output.name, output.kind) for output in program.outputs
    ]
    assert all(entry.text for entry in outputs)
    for constants in programs_page.entries(name, "Constant"):
        for constant in constants.name.split(", "):
            value = program.symbols[constant]
            assert (
                f"{value} if not defined" in constants.text
                or "default" in constants.text
                or (f"{value}," in constants.text)
            ), constant
