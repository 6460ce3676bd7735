"""Teachers: a copy of the course, and the faults of an exercise of one's own."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.course.command import ALARM, learn


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_teachers_get_all_of_it() -> None:
    assert learn("copy", "class").exit_code == 0
    assert Path("class/08-alarm/solution.golden.json").exists()
    assert len([*Path("class").glob("*/wrong/*.s")]) >= 72
    again = learn("copy", "class")
    assert (again.exit_code, "NP256" in again.output) == (2, True)
    assert learn("--course", "class", "start", "pixel").exit_code == 0


@pytest.fixture
def copy() -> Path:
    """An exercise of one's own."""
    shutil.copytree(ALARM.folder, "01-mine")
    return Path("01-mine")


def test_an_own_exercise_is_fit(copy: Path) -> None:
    result = learn("validate", str(copy))
    assert (result.exit_code, result.output) == (0, "mine: fit\n")


@pytest.mark.long
@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("page.md", "NPs answer", "word " * 300, "page.md has"),
        ("page.md", "# One", "One", "does not begin with a heading"),
        ("page.md", "](picture.png)", "](other.png)", "shows other.png, which is not there"),
        ("page.md", "![", "[", "page.md shows no picture"),
        ("page.md", "--render picture.png", "", "page.md does not say what draws its picture"),
        ("hints.md", "---", "", "hints.md has fewer than 2 steps"),
        ("starter.s", "; your program", "OUT 0, r0", "starter.s fails without a helpful word"),
        ("solution.s", "JANY    HI, found", "JANY    HS, found", "solution.s fails checks.s"),
        ("solution.s", "; solution.s -", "\n; solution.s -", "does not begin with a remark"),
        ("solution.s", "; expect: alarm == 1\n", "", "solution.s lacks a test line of checks.s"),
        ("checks.s", "; expect: words <= 16\n", "", "checks.s says nothing on words"),
        (
            "checks.s",
            "mistake: alarm == 0, 1",
            "note",
            "wrong/limit.s: its first line",
        ),
        ("wrong/limit.s", "HS, found", "HI, found", "wrong/limit.s passes all checks"),
    ],
)
def test_a_fault_of_an_own_exercise_is_named(
    copy: Path, file: str, old: str, new: str, said: str
) -> None:
    text = (copy / file).read_text()
    assert old in text
    (copy / file).write_text(text.replace(old, new))
    result = learn("validate", str(copy))
    assert result.exit_code == 1
    assert said in result.output


def test_too_few_wrong_answers_are_a_fault(copy: Path) -> None:
    for path in sorted((copy / "wrong").glob("*.s"))[2:]:
        path.unlink()
    assert "wrong/ has 2 answers, fewer than 3" in learn("validate", str(copy)).output


def test_a_starter_that_is_right_is_a_fault(copy: Path) -> None:
    shutil.copy(copy / "solution.s", copy / "starter.s")
    assert "there is nothing left to do" in learn("validate", str(copy)).output
