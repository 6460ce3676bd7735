"""``npchip learn``: the list, an exercise from start to solution, and what may go wrong."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

from npchip.course.exercise import load_course
from npchip.course.progress import FILE
from tests.course.command import ALARM, learn


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


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
        "alarm.s", "both.gif", "checks.s", "page.md", "picture.png",
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
    assert solved.output.splitlines()[-5:] == [
        "  clips   holds, on other clips too",
        "  compare 653 cycles, as many as the solution (100 %); 14 words, as many as the solution",
        "Solved.",
        "See it: npchip run alarm/alarm.s --frames alarm/both.gif --render alarm.png",
        "Next: npchip learn start count",
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
    slower = (
        "654 cycles, more than the solution's 653 (101 %); 15 words, more than the solution's 14"
    )
    assert slower in learn("check").output
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
    assert "  clips   fails on other clips" in result.output
    assert "  spots.gif: alarm is not right in frame " in result.output
    assert "compare" not in result.output
    assert record()["solved"] is False


def test_nothing_is_overwritten() -> None:
    learn("start", "alarm")
    Path("alarm/alarm.s").write_text("mine")
    again = learn("start", "alarm")
    assert again.exit_code == 0
    assert "alarm.s is as you left it" in again.output
    assert ALARM.shown_page in again.output
    assert Path("alarm/alarm.s").read_text() == "mine"


def test_what_was_removed_comes_back() -> None:
    learn("start", "alarm")
    Path("alarm/alarm.s").unlink()
    Path("alarm/checks.s").write_text("mine")
    assert "alarm.s is where you do it" in learn("start", "alarm").output
    assert Path("alarm/alarm.s").read_bytes() == (ALARM.folder / "starter.s").read_bytes()
    assert Path("alarm/checks.s").read_text() == "mine"


def present() -> str:
    (line,) = (line for line in learn().output.splitlines() if line.startswith(">"))
    return line.split()[2]


def test_the_present_exercise_is_the_one_that_was_started_last() -> None:
    learn("start", "total")
    learn("start", "alarm")
    hand_in("solution.s")
    learn("start", "total")
    assert present() == "total"
    solved = learn("check", "alarm/alarm.s").output
    assert present() == "total"
    assert solved.splitlines()[-1] == "Next: change total/total.s, then npchip learn check"
    assert "1 of 3: " in learn("hint").output


def test_the_next_exercise_is_one_that_is_not_solved() -> None:
    for name in ("alarm", "count"):
        learn("start", name)
        shutil.copy(load_course().exercises[name].solution, f"{name}/{name}.s")
        learn("check")
    assert learn("check", "alarm").output.splitlines()[-1] == "Next: npchip learn start brightest"
    assert learn().output.splitlines()[-1] == "Next: npchip learn start brightest"


@pytest.mark.parametrize("name", ["8", "08", "08-alarm"])
def test_an_exercise_has_a_number(name: str) -> None:
    assert "alarm: page.md says what to do" in learn("start", name).output
    assert present() == "alarm"
    assert learn("show", name).output == ALARM.shown_page
    assert learn("check", name).output.startswith("alarm/alarm.s: 0 of 11 points")


@pytest.mark.parametrize("name", ["0", "25", "08-count", "8-"])
def test_a_number_that_is_none_is_refused(name: str) -> None:
    result = learn("start", name)
    assert (result.exit_code, "NP661" in result.output) == (2, True)


def test_costs_are_pointed_at_where_cycles_fail_and_a_fault_is_said_once() -> None:
    learn("start", "alarm")
    text = ALARM.solution.read_text()
    Path("alarm/alarm.s").write_text(
        text.replace("send:   OUT", "send: .rept 80\n NOP\n .endr\n OUT")
    )
    lines = learn("check").output.splitlines()
    assert sum("expected cycles <= 700" in line for line in lines) == 1
    assert "  npchip asm alarm/alarm.s --listing shows what each line costs" in lines
    hand_in("starter.s")
    assert "--listing" not in learn("check").output


def test_one_known_mistake_is_named() -> None:
    """Of 0, 0, 1, 1, 1 and an alarm in the second clip the first is the cause."""
    learn("start", "alarm")
    hand_in("wrong/stays.s")
    output = learn("check").output
    assert output.count("perhaps: ") == 1
    assert "perhaps: the alarm never ends: set it to 0 in every frame" in output


def test_a_program_with_a_machine_of_its_own_is_shown_on_it() -> None:
    learn("start", "cds")
    shutil.copy(load_course().exercises["cds"].solution, "cds/cds.s")
    run = "npchip run cds/cds.s --frames coin_slide --machine cds/uneven.yaml --render cds.png"
    assert f"See it: {run}" in learn("check").output


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


def test_the_folder_decides_which_exercise_is_present(monkeypatch: pytest.MonkeyPatch) -> None:
    learn("start", "alarm")
    learn("start", "total")
    monkeypatch.chdir("alarm")
    assert learn("check").output.startswith("alarm.s: 0 of 11 points")
    assert learn("show").output == ALARM.shown_page
    assert learn("check", "total").output.startswith("../total/total.s: 0 of")
    monkeypatch.chdir("..")
    assert present() == "total"
    assert learn("check").output.startswith("total/total.s: 0 of")


@pytest.mark.parametrize(
    ("arguments", "code", "hint"),
    [
        (["start", "alarn"], "NP661", "did you mean alarm?"),
        (["check"], "NP663", "npchip learn start pixel"),
        (["check", "alarm/none.s"], "NP275", "no such file"),
        (["check", "none.s"], "NP275", "npchip learn lists the exercises"),
        (["check", "alarm.s"], "NP275", "npchip learn start alarm writes it"),
        (["check", "alarn.s"], "NP275", "did you mean alarm?"),
        (["check", "alarn"], "NP275", "did you mean alarm?"),
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
    assert "--listing" not in result.output
    assert record()["failed"] == 1
