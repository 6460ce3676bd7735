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


def test_the_first_of_several_mistakes_is_named() -> None:
    """The second may be a consequence of the first: where nothing is sent, nothing is right."""
    both = "; mistake: first == null ; nothing is sent\n; mistake: first != 1 ; it is not 1\n"
    shown = messages(SOLUTION.replace("        OUT     0, r0\n", ""), both + EXERCISE)
    assert shown.count("perhaps: ") == 1
    assert "perhaps: nothing is sent" in shown
    shown = messages(SOLUTION.replace("#0", "#1"), both + EXERCISE)
    assert "perhaps: it is not 1" in shown
    twice = EXERCISE.replace("; that is no instruction", "; no\n; mistake: error == NP003 ; twice")
    assert messages(SOLUTION.replace("ADD ", "AD "), twice).count("perhaps: ") == 1


@pytest.mark.parametrize(
    ("claim", "points"),
    [
        ("; expect: cycles <= 20", True),
        ("; expect: instructions <= 2", True),
        ("; expect: cycles[total] <= 20", True),
        ("; expect: words <= 2", False),
        ("; expect: cycles >= 20", False),
    ],
)
def test_costs_are_pointed_at_where_a_program_takes_too_long(claim: str, *, points: bool) -> None:
    shown = messages(SOLUTION, f"{EXERCISE}{claim}\n")
    assert ("npchip asm mine.s --listing shows what each line costs" in shown) is points


def test_costs_are_pointed_at_where_a_budget_is_exceeded() -> None:
    shown = messages(f".budget cycles 20\n{SOLUTION}")
    assert "npchip asm mine.s --listing" in shown


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
