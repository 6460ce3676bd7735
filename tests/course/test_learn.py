"""``npchip learn``: the list, an exercise from start to solution, and what may go wrong."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from npchip.cli.main import cli
from npchip.course.exercise import load_course
from npchip.course.progress import FILE

ALARM = load_course().exercises["alarm"]


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def learn(*arguments: str) -> Result:
    result = CliRunner().invoke(cli, ["learn", *arguments], prog_name="npchip")
    assert "Traceback" not in result.output
    return result


def record() -> dict[str, object]:
    found: dict[str, object] = json.loads(Path(FILE).read_text())["exercises"]["alarm"]
    return found


def hand_in(name: str) -> None:
    shutil.copy(ALARM.folder / name, "alarm/alarm.s")


def test_a_new_learner_sees_the_course_and_the_first_step() -> None:
    lines = learn().output.splitlines()
    assert lines[0] == "24 exercises, 0 solved"
    assert lines[2].split() == ["1", "pixel", "One", "pixel"]
    assert lines[-1] == "Next: npchip learn start pixel"
    assert not Path(FILE).exists()


def test_from_start_to_the_leader_line() -> None:
    started = learn("start", "alarm")
    assert started.exit_code == 0
    assert "Next: change alarm/alarm.s" in started.output
    assert "<!--" not in started.output
    assert {path.name for path in Path("alarm").iterdir()} == {
        "alarm.s", "checks.s", "page.md", "picture.png",
    }  # fmt: skip
    first = learn("check")
    assert first.exit_code == 1
    assert first.output.splitlines()[:5] == [
        "alarm/alarm.s: 0 of 11 points",
        "  result  0 of 3 checks hold",
        "  words   holds (5)",
        "  cycles  holds (260)",
        "  perhaps: nothing is sent yet: OUT 0, state once in every frame",
    ]
    assert "  checks.s:11: expected alarm == 0, 0, 1, 1, 0; found null" in first.output
    hand_in("solution.s")
    solved = learn("check")
    assert solved.exit_code == 0
    assert solved.output.splitlines()[-3:] == [
        "  hidden  holds",
        "  leader  653 cycles, 100 % of the solution's 653; 14 words, the solution has 14",
        "Solved. Next: npchip learn start count",
    ]
    assert record() == {
        "checks": 2, "failed": 1, "hints": 0, "points": 11, "points_of": 11,
        "solved": True, "cycles": 653, "percent": 100,
    }  # fmt: skip
    listed = learn().output
    assert "> " in listed
    assert "solved, 100 % of the solution's cycles" in listed


def test_a_quicker_program_leads_and_a_slower_one_keeps_the_record() -> None:
    learn("start", "alarm")
    text = ALARM.solution.read_text()
    Path("alarm/alarm.s").write_text(text.replace("send:   OUT", "send:   NOP\n        OUT"))
    assert "101 % of the solution's" in learn("check").output
    assert record()["percent"] == 101
    slower = text.replace("send:   OUT", "send:   .rept 2\n        NOP\n        .endr\n OUT")
    Path("alarm/alarm.s").write_text(slower)
    assert learn("check").exit_code == 0
    assert record()["cycles"] == 654
    hand_in("solution.s")
    learn("check")
    assert record()["percent"] == 100


def test_what_was_learnt_by_heart_is_not_solved() -> None:
    """Answers to the shown clips alone are right by checks.s, and lead nowhere."""
    learn("start", "alarm")
    Path("alarm/alarm.s").write_text(
        """\
.output alarm, 0, scalar
.reg value, r0
.reg state, r1
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      value, [0]
        CMP     value, #200
        MOV     state, #0
        JNONE   HI, send
        MOV     state, #1
send:   OUT     0, state
        JMP     frame
"""
    )
    result = learn("check")
    assert result.exit_code == 1
    assert "alarm/alarm.s: 11 of 11 points" in result.output
    assert "not on other clips" in result.output
    assert "leader" not in result.output
    assert record()["solved"] is False


def test_nothing_is_overwritten() -> None:
    learn("start", "alarm")
    Path("alarm/alarm.s").write_text("mine")
    again = learn("start", "alarm")
    assert (again.exit_code, "NP256" in again.output) == (2, True)
    assert Path("alarm/alarm.s").read_text() == "mine"


def test_hints_come_one_by_one() -> None:
    learn("start", "alarm")
    assert learn("hint").output.count(" of 3: ") == 1
    assert learn("hint").output.count(" of 3: ") == 2
    last = learn("hint")
    assert last.output.count(" of 3: ") == 3
    assert "npchip learn solution alarm" in last.output
    assert record()["hints"] == 3


def test_the_solution_comes_after_three_failed_checks_or_now() -> None:
    learn("start", "alarm")
    early = learn("solution", "alarm")
    assert (early.exit_code, "after 3 more failed checks" in early.output) == (2, True)
    assert "A better one would" in learn("solution", "alarm", "--now").output
    for _ in range(3):
        assert learn("check").exit_code == 1
    shown = learn("solution", "alarm")
    assert shown.exit_code == 0
    assert "JANY    HI, found" in shown.output
    assert "expect:" not in shown.output


def test_a_file_is_checked_by_its_name_its_folder_or_an_option() -> None:
    Path("elsewhere").mkdir()
    shutil.copy(ALARM.solution, "elsewhere/alarm.s")
    assert learn("check", "elsewhere/alarm.s").exit_code == 0
    shutil.copy(ALARM.solution, "elsewhere/mine.s")
    assert learn("check", "elsewhere/mine.s", "--exercise", "alarm").exit_code == 0
    assert learn("check", "elsewhere/mine.s", "--exercise", "pixel").exit_code == 1
    Path("alarm").mkdir()
    shutil.copy(ALARM.solution, "alarm/mine.s")
    assert learn("check", "alarm/mine.s").exit_code == 0


def test_what_is_no_program_is_not_solved_and_nothing_waits_for_it() -> None:
    learn("start", "alarm")
    assert learn("check", "alarm").output.startswith("alarm/alarm.s: 0 of 11 points")
    Path("alarm/alarm.s").unlink()
    missing = learn("check")
    assert (missing.exit_code, "NP275" in missing.output) == (2, True)
    os.mkfifo("alarm/alarm.s")
    pipe = learn("check")
    assert (pipe.exit_code, "not run: no file" in pipe.output) == (1, True)
    Path("alarm/alarm.s").unlink()
    Path("alarm/alarm.s").symlink_to("/etc/passwd")
    link = learn("check")
    assert (link.exit_code, "NP028" in link.output) == (1, True)


def test_within_the_folder_of_an_exercise(monkeypatch: pytest.MonkeyPatch) -> None:
    learn("start", "alarm")
    hand_in("solution.s")
    monkeypatch.chdir("alarm")
    assert learn("check").exit_code == 0
    assert learn("check", "alarm.s").exit_code == 0
    monkeypatch.chdir("..")
    assert record()["checks"] == 2


@pytest.mark.parametrize(
    ("arguments", "code", "hint"),
    [
        (["start", "alarn"], "NP661", "did you mean alarm?"),
        (["check"], "NP663", "npchip learn start pixel"),
        (["check", "alarm/none.s"], "NP275", "no such file"),
        (["check", "none.s"], "NP663", "npchip learn start pixel"),
        (["check", "alarm.s"], "NP275", ""),
        (["--course", "nowhere", "show", "alarm"], "NP660", ""),
        (["--course", ".", "show", "alarm"], "NP660", "no exercises"),
        (["validate", "No-Name!"], "NP660", "small letters"),
        (["validate", "mine"], "NP660", "has no page.md"),
    ],
)
def test_bad_usage_says_where_and_what_to_do(arguments: list[str], code: str, hint: str) -> None:
    result = learn(*arguments)
    assert result.exit_code == 2
    assert code in result.output
    assert hint in result.output


@pytest.mark.parametrize(
    "text",
    [
        "", "[]", "{}", "\0", '{"schema": 2}', '{"schema": 1, "current": 3, "exercises": {}}',
        '{"schema": 1, "current": "", "exercises": []}',
        '{"schema": 1, "current": "", "exercises": {"alarm": {"checks": "3"}}}',
        '{"schema": 1, "current": "", "exercises": {"alarm": {"checks": -1}}}',
        '{"schema": 1, "current": "", "exercises": {"alarm": {"solved": 1}}}',
        '{"schema": 1, "current": "", "exercises": {"alarm": {"other": 1}}}',
        '{"schema": 1, "current": "", "exercises": {"alarm": {"checks": 1e999}}}',
        "[" * 5000,
    ],
)  # fmt: skip
def test_damaged_progress_is_refused_and_kept(text: str) -> None:
    Path(FILE).write_text(text)
    for arguments in ([], ["start", "alarm"]):
        result = learn(*arguments)
        assert (result.exit_code, "NP662" in result.output) == (2, True)
    assert Path(FILE).read_text() == text


def test_a_program_that_does_not_assemble_is_not_solved_yet() -> None:
    learn("start", "alarm")
    Path("alarm/alarm.s").write_text("frame: EXPOS\n        LD r99, [0]\n")
    result = learn("check")
    assert result.exit_code == 1
    assert "did you mean EXPOSE?" in result.output
    assert record()["failed"] == 1


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
    (copy / "wrong" / "limit.s").unlink()
    (copy / "wrong" / "mask.s").unlink()
    assert "wrong/ has 2 answers, fewer than 3" in learn("validate", str(copy)).output


def test_a_starter_that_is_right_is_a_fault(copy: Path) -> None:
    shutil.copy(copy / "solution.s", copy / "starter.s")
    assert "there is nothing left to do" in learn("validate", str(copy)).output
