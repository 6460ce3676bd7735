"""docs/programs.md and docs/programming.md: their figures are those of runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from examples import programming_page, programs_page, silicon
from examples.measure import ORDER, PROGRAMS
from npchip import AssemblyError, assemble
from tests.support.programs import assembled

ROOT = Path(__file__).parents[2]
ASM = ROOT / "asm"


def test_there_are_programs() -> None:
    assert set(ORDER) <= set(PROGRAMS) == {path.stem for path in ASM.glob("*.s")}


@pytest.mark.long
def test_the_table_of_programs_is_what_its_script_measures() -> None:
    page = (ROOT / "docs" / "programs.md").read_text(encoding="utf-8")
    assert page == programs_page.document(), "python -m examples.programs_page writes it"


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_head_states_all_outputs_and_constants(name: str) -> None:
    program = assembled(name)
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


def constants(name: str) -> set[str]:
    """Return the names of the constants that the head of a program states."""
    entries = programs_page.entries(name, "Constant")
    return {constant for entry in entries for constant in entry.name.split(", ")}


@pytest.mark.parametrize("value", [0, 256])
@pytest.mark.parametrize("name", [name for name in PROGRAMS if "THRESHOLD" in constants(name)])
def test_a_threshold_that_a_head_excludes_is_refused(name: str, value: int) -> None:
    with pytest.raises(AssemblyError, match="THRESHOLD must be 1 to 255"):
        assemble(ASM / f"{name}.s", defines={"THRESHOLD": value})


# ---- docs/programming.md

PROGRAMMING = programming_page.PAGE.read_text(encoding="utf-8")


@pytest.mark.long
def test_pieces_of_programs_stand_in_their_sources_and_cost_what_is_said() -> None:
    assert len(programming_page.BLOCK.findall(PROGRAMMING)) >= 30
    assert PROGRAMMING.count("```asm\n") == len(programming_page.BLOCK.findall(PROGRAMMING))
    assert programming_page.with_cycles(PROGRAMMING) == PROGRAMMING


def test_a_piece_that_no_source_has_is_noticed() -> None:
    page = "```asm\n; asm/imaging.s\n        SUB     f, brightness\n```"
    with pytest.raises(SystemExit, match=r"not in asm/imaging\.s"):
        programming_page.with_cycles(page)


@pytest.mark.parametrize(
    ("file", "text", "cycles"),
    [
        ("asm/imaging.s", "        SUB     f, dark\n        WHERE   LO", 2),
        ("asm/imaging.s", "        OUT     0, f\n        ADD     pixel, #1", 9),
        ("asm/median.s", ".macro min a, b                 ; a := the smaller one\n", 4),
        ("asm/statistics.s", "        .rept 8, bit            ; a quotient of 8 bits\n", 80),
        ("asm/smooth.s", "        step    sum, sumh, this, thish, next, nexth\n        ST", 5),
    ],
)
def test_passes_counted_by_hand(file: str, text: str, cycles: int) -> None:
    first, last = programming_page.lines_of(file, text)
    if text.startswith(".macro"):
        last += 4
    elif not text.endswith("\n"):
        last += 1
    assert programming_page.cost(file, first, last, "default") == cycles


@pytest.mark.long
def test_what_new_instructions_would_save() -> None:
    """Copies of the program send the same; their cycles are those of the page."""
    assert f"\n| {' | '.join(silicon.row('median'))} |\n" in PROGRAMMING


@pytest.mark.thorough
def test_what_new_instructions_would_save_in_all_programs() -> None:
    assert programming_page.document(PROGRAMMING) == PROGRAMMING
