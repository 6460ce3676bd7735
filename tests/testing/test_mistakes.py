"""``; mistake:`` lines name what went wrong in a run that fails."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from npchip.cli.main import cli

EXERCISE = """\
; mistake: status == cycle-limit ; the loop never ends
; run: flat levels=1,2 max-cycles=2000
; expect: first == 1, 2
; mistake: first == 2, 3   ; you add one: ; why?
; mistake: error == NP305  ; JMP is missing
; mistake: error == NP003  ; that is no instruction
"""
SOLUTION = """\
.output first, 0, scalar
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        ADD     r0, #0
        OUT     0, r0
        JMP     frame
"""


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def messages(program: str, exercise: str = EXERCISE, *options: str) -> str:
    Path("ex.s").write_text(exercise)
    Path("mine.s").write_text(program)
    arguments = ["test", "ex.s", "--program", "mine.s", *options]
    return CliRunner().invoke(cli, arguments, prog_name="npchip").output


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (("#0", "#1"), "you add one: ; why?"),
        (("JMP     frame", ""), "JMP is missing"),
        (("JMP     frame", "x: JMP x"), "the loop never ends"),
        (("ADD ", "AD "), "that is no instruction"),
    ],
)
def test_a_known_mistake_is_named_first(wrong: tuple[str, str], said: str) -> None:
    lines = messages(SOLUTION.replace(*wrong)).splitlines()
    assert lines[2].strip() == f"perhaps: {said}"
    assert len(lines) > 4
    assert said in messages(SOLUTION.replace(*wrong), EXERCISE, "--table").splitlines()[1]


def test_nothing_is_said_of_another_fault_or_of_none() -> None:
    assert "perhaps" not in messages(SOLUTION.replace("#0", "#2"))
    passed = messages(SOLUTION, EXERCISE + "; mistake: words == 6 ; this holds, but all is well\n")
    assert passed.splitlines()[0] == "mine.s  1 passed"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("; mistake: first == 3", "a mistake needs words for its author"),
        ("; mistake: golden ; words", "a mistake is a comparison, not a golden"),
        ("; mistakes: first == 3 ; words", "did you mean 'mistake:'?"),
        ("; mistake: first = 3 ; words", "did you mean ==?"),
    ],
)
def test_a_line_that_names_nothing_is_refused(line: str, said: str) -> None:
    shown = messages(SOLUTION, f"{EXERCISE}{line}\n")
    assert said in shown
    assert "ex.s:7" in shown


def test_a_mistake_of_an_unknown_output_is_refused_in_the_program_itself() -> None:
    Path("own.s").write_text(f"{EXERCISE}; mistake: frist == 3 ; words\n{SOLUTION}")
    shown = CliRunner().invoke(cli, ["test", "own.s"], prog_name="npchip")
    assert shown.exit_code == 2
    assert "did you mean first?" in shown.output
