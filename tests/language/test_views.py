"""Cards, completion, folding, hints and colours, without a client."""

from __future__ import annotations

from pathlib import Path

import pytest

from npchip.editors.rules import KINDS
from npchip.isa import load_isa
from npchip.language.analysis import Analysis, Analyst
from npchip.language.cards import card
from npchip.language.colours import NAMES, coloured
from npchip.language.completion import completion
from npchip.language.folding import folds
from npchip.language.hints import hints
from npchip.language.lines import code_end, word_at
from tests.support.programs import ASM

TRAJECTORY = Path(ASM) / "trajectory.s"


@pytest.fixture(scope="module")
def trajectory() -> Analysis:
    return Analyst().analyse(TRAJECTORY.resolve())


def test_hints_add_up(trajectory: Analysis) -> None:
    """Every word is counted once in the files that hold the lines outside macros."""
    assert trajectory.examined is not None
    program = trajectory.examined.program
    assert program is not None
    outside = {(line.written_at.file, line.written_at.line) for line in program.source}
    assert sum(trajectory.costs[key].words for key in outside) == len(program.words)
    cycles = program.cycles(trajectory.machine, trajectory.isa)
    assert sum(trajectory.costs[key].cycles for key in outside) == sum(cycles)
    lines = TRAJECTORY.read_text().split("\n")
    found = [*hints(trajectory, str(TRAJECTORY.resolve()), lines)]
    budget = next(n for n, line in enumerate(lines, 1) if line.startswith(".budget words"))
    assert (budget, "0 left, 338 in the ROM") in {(hint.line, hint.text) for hint in found}
    for hint in found:
        assert lines[hint.line - 1][: hint.column].strip()
        assert ";" not in lines[hint.line - 1][: hint.column]


def test_colours_cover_the_code(trajectory: Analysis) -> None:
    lines = TRAJECTORY.read_text().split("\n")
    found = [*coloured(lines, str(TRAJECTORY.resolve()), trajectory.names, trajectory.isa)]
    assert {item.kind for item in found} <= KINDS.keys() | set(NAMES.values())
    ends = (0, 0)
    for item in found:
        assert (item.line, item.column) >= ends
        ends = (item.line, item.column + item.length)
    words = {lines[item.line][item.column :][: item.length]: item.kind for item in found}
    assert words["last_row"] == "register"
    assert words["THRESHOLD"] == "constant"
    assert words["centre"] == "macro"
    assert words["CALL"] == "mnemonic"


def test_folds_of_unbalanced_files_lie_within_them() -> None:
    isa = load_isa()
    text = "END\n.endm\nWHERE HI\n.macro a\nELSE\n.if 1\n.else\n.endr\n.endif\n; x\n; y\n; z"
    lines = text.split("\n")
    found = folds(lines, isa)
    assert all(0 < fold.first < fold.last <= len(lines) for fold in found)
    assert {(fold.first, fold.last) for fold in found} == {(7, 9), (10, 12)}


def test_cards_of_wrong_lines(tmp_path: Path) -> None:
    path = tmp_path / "a.s"
    path.write_text("  MVO r1, 7 ; MOV\n")
    found = Analyst().analyse(path)
    text = path.read_text().rstrip()

    def said(word: str) -> str | None:
        shown = card(found, str(path), 1, text.index(word), text)
        return shown.text if shown else None

    assert said("MVO") is None
    assert said("MOV") is None  # in a comment
    assert said("7") == "7 = 0x07 = 0b00000111"
    assert said("r1") == "**r1** · a register of every NP: a byte"


def test_nothing_is_offered_in_comments_numbers_and_strings(trajectory: Analysis) -> None:
    file = str(TRAJECTORY.resolve())
    for before in ("; AD", "  MOV r1, #1", '.error "AD', "  MOV r1, $ AD"):
        assert completion(trajectory, file, 60, before).offers == []
    assert completion(trajectory, file, 60, "x: MO").column == 3


def test_places_in_a_line() -> None:
    line = 'x:  .error "a;b" ; c'
    assert code_end(line) == line.index(" ; c")
    assert code_end("  MOV r1, r2  ") == 12
    assert code_end("; only") == 0
    token = word_at("  MOV r1", 5)
    assert token is not None
    assert token.text == "MOV"
    assert word_at("  MOV r1 ; r2", 12) is None
