"""Meanings of names: their scopes, their places, and the programs that they are in."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from npchip.base.errors import InputError
from npchip.language.analysis import Analysis, Analyst
from npchip.language.includes import Includes
from npchip.language.names import Use
from npchip.language.rename import check_new, everywhere, in_tests
from npchip.lsp.session import Session
from tests.support.programs import ASM

SCOPES = """\
.macro wait times
        MOV     r1, #times
.here:  SUB     r1, #1
        JANY    NE, .here
.endm
one:    MOV     r0, #1
.here:  SUB     r0, #1
        wait    3
        JANY    NE, .here
two:    MOV     r0, #2
.here:  .rept   2, index
        ADD     r0, #index
        .endr
        JANY    NE, .here
        JMP     one
"""


def analysed(tmp_path: Path, text: str) -> Analysis:
    path = tmp_path / "a.s"
    path.write_text(text)
    return Analyst().analyse(path)


def lines(analysis: Analysis, line: int, word: str) -> list[tuple[int, bool]]:
    """Return the lines of all places of the word of a line, and whether they define it."""
    text = analysis.root.read_text().split("\n")[line - 1]
    use = analysis.names.at(str(analysis.root), line, text.index(word))
    assert use is not None
    return [(each.span.line.number, each.kind is not None) for each in analysis.names.all(use.name)]


def test_scopes(tmp_path: Path) -> None:
    found = analysed(tmp_path, SCOPES)
    assert [fault["code"] for fault in found.faults] == ["NPW01"]  # two
    assert lines(found, 4, ".here") == [(3, True), (4, False)]
    assert lines(found, 9, ".here") == [(7, True), (9, False)]
    assert lines(found, 14, ".here") == [(11, True), (14, False)]
    assert lines(found, 2, "times") == [(1, True), (2, False)]
    assert lines(found, 12, "index") == [(11, True), (12, False)]
    assert lines(found, 15, "one") == [(6, True), (15, False)]
    assert lines(found, 8, "wait") == [(1, True), (8, False)]


def test_words_of_operands_are_no_names(tmp_path: Path) -> None:
    text = ".equ signal, 64\n.output sum, 0, scalar\n.reg sum, r1\nx: SAMPLE signal, signal\n"
    found = analysed(tmp_path, f"{text} MOV sum, #1\n OUT 0, sum\n JANY EQ, x\n JMP x\n")
    assert lines(found, 1, "signal") == [(1, True), (4, False)]
    assert lines(found, 3, "sum") == [(3, True), (5, False), (6, False)]
    assert lines(found, 2, "sum") == [(2, True)]
    assert not [use for use in found.names.uses if use.name.text in {"EQ", "scalar", "r1"}]


def test_a_position_names_outputs(tmp_path: Path) -> None:
    text = ".reg row, r1\n.output row, 0, scalar\n.output col, 1, scalar\n.equ far, 2\n"
    found = analysed(tmp_path, f"{text}.position row, col, far\n MOV row, #1\n")
    assert lines(found, 2, "row") == [(2, True), (5, False)]
    assert lines(found, 5, "far") == [(4, True), (5, False)]
    assert lines(found, 6, "row") == [(1, True), (6, False)]


def test_names_hold_while_lines_are_wrong(tmp_path: Path) -> None:
    found = analysed(tmp_path, ".reg total, r3\n  MVO total, #1\n  ADD total, #$\n  ADD total,\n")
    assert len(found.faults) == 3
    assert [line for line, _ in lines(found, 1, "total")] == [1, 2, 3, 4]


def test_every_name_of_asm_is_known() -> None:
    analyst = Analyst()
    words = {"north", "east", "south", "west", "COL", "ROW", "LO", "HS", "BRIGHTEST"}
    for path in sorted(Path(ASM).glob("t*.s")):
        found = analyst.analyse(path)
        assert found.faults == []
        unknown = {
            use.name.text
            for use in found.names.uses
            if not found.names.definitions(use.name) and use.name.text not in found.values
        }
        assert unknown <= words  # arguments of macros, and a name that nothing need define


# ---- files


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "lib").mkdir()
    (tmp_path / "a.s").write_text('.include "lib/one.s"\n.equ N, 3\n  MOV r0, #N\n  HALT\n')
    (tmp_path / "b.s").write_text(' .INCLUDE "lib/two.s"\n  HALT\n')
    (tmp_path / "c.s").write_text('; .include "lib/one.s"\n  HALT\n')
    (tmp_path / "lib" / "one.s").write_text('.include "two.s"\n  ADD r0, #N\n')
    (tmp_path / "lib" / "two.s").write_text("  MOV r1, #1\n")
    return tmp_path


def test_programs_of_a_file(folder: Path) -> None:
    known = Includes()

    def programs(name: str, texts: dict[Path, str] | None = None) -> list[str]:
        return [path.name for path in known.programs(folder / name, folder, texts or {})]

    assert programs("a.s") == ["a.s"]
    assert programs("lib/one.s") == ["a.s"]
    assert programs("lib/two.s") == ["a.s", "b.s"]
    assert programs("c.s") == ["c.s"]
    unsaved = {folder / "c.s": '.include "lib/one.s"\n'}
    assert programs("lib/one.s", unsaved) == ["a.s", "c.s"]
    (folder / "a.s").write_text("  HALT\n")
    os.utime(folder / "a.s", ns=(1, 1))
    assert programs("lib/one.s") == ["one.s"]


def test_files_that_include_each_other(tmp_path: Path) -> None:
    (tmp_path / "a.s").write_text('.include "b.s"\n')
    (tmp_path / "b.s").write_text('.include "a.s"\n')
    assert Includes().programs(tmp_path / "a.s", tmp_path, {}) == [tmp_path / "a.s"]


def test_a_session_reads_texts_that_are_not_saved(folder: Path) -> None:
    session = Session()
    session.folders = [folder]
    one = folder / "lib" / "one.s"
    session.open(one, one.read_text())
    assert session.program(one) == folder / "a.s"
    assert [*session.faults(folder / "a.s")] == []
    session.change(one, one.read_text().replace("#N", "#M"))
    ((path, fault),) = session.faults(folder / "a.s")
    assert (path, fault["code"]) == (one, "NP007")
    before = session.analysis(folder / "a.s")
    assert session.analysis(folder / "a.s") is before
    session.close(one)
    assert [*session.faults(folder / "a.s")] == []


# ---- another name


def use_of(analysis: Analysis, text: str) -> Use:
    return next(use for use in analysis.names.uses if use.name.text == text)


def test_a_name_is_one_in_all_programs_that_share_a_file(folder: Path) -> None:
    (folder / "b.s").write_text('.include "lib/one.s"\n.equ N, 4\n  HALT\n')
    session = Session()
    session.folders = [folder]
    found = session.analysis(folder / "a.s")
    known = everywhere(use_of(found, "N"), found, session.analyses)
    places = [(place.path.name, place.line, place.defines) for place in known.places]
    assert places == [("a.s", 2, True), ("a.s", 3, False), ("b.s", 2, True), ("one.s", 2, False)]
    assert {program.root.name for program, _ in known.programs} == {"a.s", "b.s"}


@pytest.mark.parametrize("new", ["", "1st", "a b", ".local", "r3", "R3", "add", "NP_ROWS", "two"])
def test_names_that_cannot_be_given(tmp_path: Path, new: str) -> None:
    found = analysed(tmp_path, SCOPES)
    with pytest.raises(InputError, match="NP671"):
        check_new(new, use_of(found, "one").name, [found])


def test_names_in_test_lines(tmp_path: Path) -> None:
    text = (
        "; expect: sum[0] == 1\n; run: a define=N=3,NN=4 frames=sum\n; sum is N\n"
        ".equ N, 1\n.output sum, N, scalar\n.reg t, r1\n  OUT N, t\n  HALT\n"
    )
    found = analysed(tmp_path, text)
    at = text.split("\n")
    output = next(use.name for use in found.names.uses if use.name.space == "output")
    assert [*in_tests(output, at)] == [(1, 10)]
    assert [*in_tests(use_of(found, "N").name, at)] == [(2, at[1].index("N=3"))]
