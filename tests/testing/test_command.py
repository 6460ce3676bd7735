"""``npchip test``: folders, goldens, submissions, JUnit, exit codes."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip.cli.main import cli

FIRST_PIXEL = """\
    .output first, 0, scalar
    .output plane, 1, plane
    .equ ADDED, 0
    frame:  EXPOSE
            SAMPLE  signal, 0
            LD      r0, [0]
            ADD     r0, #ADDED
            OUT     1, r0
            OUT     0, r0
            JMP     frame
"""
GOOD = f"; run: flat levels=1,2,3\n; expect: first == 1, 2, 3\n; expect: golden\n{FIRST_PIXEL}"

Files = Callable[..., Path]


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Files:
    """Write sources into a folder, which becomes the current one; not as in CI."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("CI", raising=False)

    def write(**sources: str) -> Path:
        for name, text in sources.items():
            (tmp_path / f"{name}.s").write_text(dedent(text), encoding="utf-8")
        return tmp_path

    return write


def test(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, ["test", *map(str, arguments)], prog_name="npchip")


test.__test__ = False  # type: ignore[attr-defined]


def changed(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_record_pass_change_differ(files: Files) -> None:
    here = files(a=GOOD)
    first = test("a.s")
    assert first.exit_code == 1
    assert "a.s:3: expected golden; nothing is recorded (npchip test --update" in first.output
    update = test("a.s", "--update")
    assert update.exit_code == 0
    assert "a.golden.json updated: flat" in update.output
    again = test("a.s")
    assert (again.exit_code, again.output) == (0, "a.s  1 passed\n1 passed, 0 failed\n")

    changed(here / "a.s", "ADD     r0, #ADDED", "ADD     r0, #1\nNOP")
    differs = test("a.s")
    assert differs.exit_code == 1
    assert "a.s:2: expected first == 1, 2, 3; found 2 in frame 0, not 1 (and 2 mo" in differs.output
    assert "golden:           words   expected   7  found   8  +1, +14.3 %" in differs.output
    assert "golden: frame 0   first   expected   1  found   2" in differs.output
    assert "0 passed, 1 failed" in differs.output


def test_only_what_has_changed_is_written(files: Files) -> None:
    here = files(a=GOOD, b=GOOD.replace("flat", "other"))
    test(here, "--update")
    before = {path: path.stat().st_mtime_ns for path in here.glob("*.golden.json")}
    assert len(before) == 2
    changed(here / "b.s", "levels=1,2,3", "levels=1,2,4")
    changed(here / "b.s", "== 1, 2, 3", "== 1, 2, 4")
    update = test(here, "--update")
    assert "b.golden.json updated: other" in update.output
    assert "a.golden.json" not in update.output
    after = {path: path.stat().st_mtime_ns for path in before}
    assert [path.name for path in before if before[path] != after[path]] == ["b.golden.json"]


def test_an_update_with_a_pattern_leaves_the_other_runs_alone(files: Files) -> None:
    two = GOOD.replace("; run: flat", "; expect: golden\n; run: dark levels=0\n; run: flat", 1)
    here = files(a=two)
    test("a.s", "--update")
    changed(here / "a.s", "#ADDED", "#0\nNOP")
    update = test("a.s", "--update", "-k", "DARK")
    assert "updated: dark\n" in update.output
    assert "1 passed, 0 failed, 1 not selected" in update.output
    after = test("a.s")
    assert after.exit_code == 1
    assert "  flat\n" in after.output
    assert "  dark\n" not in after.output


def test_a_golden_that_no_run_asks_for_is_stale(files: Files) -> None:
    here = files(a=GOOD)
    test("a.s", "--update")
    changed(here / "a.s", "run: flat", "run: bright")
    stale = test("a.s")
    assert stale.exit_code == 1
    assert "'flat' is recorded, but no run of that name expects it" in stale.output
    changed(here / "a.s", "; expect: golden", "; golden no more")
    update = test("a.s", "--update")
    assert "updated: flat removed" in update.output
    assert not (here / "a.golden.json").exists()


def test_a_golden_is_written_anew_where_it_is_damaged(files: Files) -> None:
    here = files(a=GOOD)
    (here / "a.golden.json").write_text("<<<<<<< HEAD\n{}")
    broken = test("a.s")
    assert broken.exit_code == 2
    assert "NP276" in broken.output
    assert test("a.s", "--update", "-k", "flat").exit_code == 2
    assert test("a.s", "--update").exit_code == 0
    assert json.loads((here / "a.golden.json").read_text())["schema"] == 1


def test_no_update_in_ci(files: Files, monkeypatch: pytest.MonkeyPatch) -> None:
    here = files(a=GOOD)
    monkeypatch.setenv("CI", "true")
    refused = test("a.s", "--update")
    assert refused.exit_code == 2
    assert "NP277" in refused.output
    assert not (here / "a.golden.json").exists()


def test_what_was_not_recorded_cannot_be_compared(files: Files) -> None:
    here = files(a=GOOD.replace("expect: golden", "expect: golden cycles"))
    test("a.s", "--update")
    changed(here / "a.s", "golden cycles", "golden")
    assert "expected golden; no outputs are recorded (" in test("a.s").output
    changed(here / "a.s", "expect: golden", "expect: golden outputs")
    test("a.s", "--update")
    changed(here / "a.s", "#ADDED", "#0\nNOP")
    assert test("a.s").exit_code == 0  # other cycles, the same outputs
    changed(here / "a.s", "golden outputs", "golden cycles")
    assert "expected golden cycles; no cycles are recorded (" in test("a.s").output


def test_parts_of_programs_are_not_told(files: Files) -> None:
    """An included source is not a program without tests; if it has tests, they are run."""
    program = f'{GOOD.replace("; expect: golden", "")}.include "part.s"\n'
    here = files(a=program, part="  NOP\n", library="  HALT\n")
    told = test(here)
    assert told.exit_code == 0
    assert "part.s" not in told.output
    assert "1 passed, 0 failed, 1 without tests" in told.output
    assert test(here / "part.s").exit_code == 1  # whoever names it wants it tested
    changed(here / "part.s", "NOP", "HALT\n; expect: words == 1")
    assert "2 passed, 0 failed, 1 without tests" in test(here).output
    changed(here / "a.s", ".include", "; .include")
    changed(here / "part.s", "; expect: words == 1", "")
    assert "1 passed, 0 failed, 2 without tests" in test(here).output


def test_of_a_folder_only_tests_are_run_and_the_others_are_told(files: Files) -> None:
    here = files(a=GOOD.replace("; expect: golden\n", ""), library="  HALT\n")
    (here / ".hidden").mkdir()
    shutil.copy(here / "library.s", here / ".hidden" / "test_x.s")
    done = test(here)
    assert done.exit_code == 0
    assert f"{here / 'library.s'}  no tests\n1 passed, 0 failed, 1 without tests" in done.output
    for name in ("library.s", "test_none.s"):
        shutil.copy(here / "library.s", here / "test_none.s")
        named = test(here / name)
        assert named.exit_code == 1
        assert "nothing to check: it has no '; expect:' line [NP275]" in named.output
    assert test(here).exit_code == 1


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["nowhere.s"], "NP275"),
        (["empty"], "NP275"),
        (["a.s", "-k", "nothing"], "NP275"),
        (["a.s", "a.s", "--program", "a.s"], "NP278"),
        ([".", "--program", "a.s"], "NP278"),
        (["a.s", "--program", "a.s", "--update"], "NP278"),
        (["a.s", "--program", "nowhere.s"], "NP275"),
        (["library.s", "--program", "a.s"], "NP275"),
        (["a.s", "--junit", "nowhere/report.xml"], "NP250"),
        (["a.s", "--engine", "steam"], "NP104"),
    ],
)
def test_bad_usage(files: Files, arguments: list[str], code: str) -> None:
    here = files(a=GOOD, library="  HALT\n")
    (here / "empty").mkdir()
    done = test(*arguments)
    assert done.exit_code == 2
    assert f"[{code}]" in done.output


def test_what_cannot_be_run_is_an_error_and_the_others_are_run(files: Files) -> None:
    here = files(
        bad_line="; expect: x = 1\n  HALT\n",
        bad_program="; expect: words == 1\n  HLT\n",
        idle="; run: a levels=1\n" + FIRST_PIXEL,
        no_clip="; run: a frames=nowhere.npy\n; expect: first == 1\n" + FIRST_PIXEL,
        no_frames="; expect: first == 1\n" + FIRST_PIXEL,
        no_machine="; run: a machine=defualt levels=1\n; expect: first == 1\n" + FIRST_PIXEL,
        no_constant="; run: a levels=1 define=ADED=1\n; expect: first == 1\n" + FIRST_PIXEL,
        no_output="; run: a levels=1\n; expect: frist == 1\n" + FIRST_PIXEL,
        works="; expect: status == halted\n  HALT\n",
    )
    done = test(here)
    assert done.exit_code == 2
    for place in (
        "bad_line.s:1:13: error: expected one of == != < <= > >=, found '=' [NP270]",
        "bad_program.s:2:3: error:",
        "idle.s:1:8: error: run 'a' expects nothing [NP275]",
        f"no_clip.s:1:8: error: {here / 'nowhere.npy'}: no such file or directory [NP210]",
        "no_frames.s:1:11: error: no_frames takes frames, but this run has none [NP279]",
        "no_machine.s:1:8: error: unknown machine 'defualt'",
        "no_constant.s:1:8: error:",
        "no_output.s:2:11: error: no_output has no output 'frist' [NP273]",
    ):
        assert str(here / place) in done.output
    assert done.output.endswith("1 passed, 0 failed, 8 errors\n")


def test_budget_and_endless_loop_fail(files: Files) -> None:
    loop = "; run: a levels=1\n; expect: frames == 1\nf: EXPOSE\nl: JMP l\n"
    files(a=f"; run: a levels=1 machine=default,conservative\n; expect: golden outputs\n"
            f".budget cycles 9\n{dedent(FIRST_PIXEL)}", loop=loop)  # fmt: skip
    done = test("a.s", "loop.s", "--update")
    assert done.exit_code == 1
    assert "a.s     1 passed, 1 failed" in done.output  # budgets hold on the default machine
    assert "'.budget cycles' allows 9 [NP320]" in done.output
    assert "frame 0 reached the limit of 1,000,000 cycles [NP321]" in done.output


def test_a_failure_can_be_expected(files: Files) -> None:
    files(a="""\
        ; run: a levels=1
        ; expect: error == NP310
        ; expect: status == failed
        ; expect: golden
        .output x, 0, scalar
        EXPOSE
        ROW r0
        OUT 0, r0
        HALT
        """)  # fmt: skip
    assert test("a.s", "--update").exit_code == 0
    assert test("a.s").exit_code == 0


def test_clips_memory_and_machine_files_lie_beside_the_source(
    files: Files, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files()
    folder = tmp_path / "deep"
    folder.mkdir()
    np.save(folder / "clip.npy", np.full((9, 64, 80), 5, np.uint8))
    np.save(folder / "added.npy", np.full((1, 8, 10), 3, np.uint8))
    (folder / "slow.yaml").write_text("summary: x\nextends: conservative\n")
    (folder / "a.s").write_text(dedent("""\
        ; run: a frames=clip.npy first=2 memory=200=added.npy machine=default,slow.yaml
        ; expect: sum == 8
        ; expect: frames == 2
        ; expect: golden
        .output sum, 0, scalar
        frame: EXPOSE
        SAMPLE signal, 0
        LD r0, [0]
        LD r1, [200]
        ADD r0, r1
        OUT 0, r0
        JMP frame
        """))  # fmt: skip
    monkeypatch.chdir("/")
    done = test(folder, "--update")
    assert done.exit_code == 0, done.output
    golden = json.loads((folder / "a.golden.json").read_text())
    assert list(golden["runs"]) == ["a", "a@slow"]


def test_grading(files: Files) -> None:
    here = files(
        exercise=f"; expect: cycles <= 350\n{GOOD}",
        broken="; no output\n  HLT\n",
    )
    assert test("exercise.s", "--update").exit_code == 0
    class_ = here / "class"
    class_.mkdir()
    solution = dedent(FIRST_PIXEL)
    (class_ / "ann.s").write_text(solution.replace("OUT     0", "NOP\nOUT     0"))
    (class_ / "bob.s").write_text(solution.replace("#ADDED", "#1"))
    (class_ / "eve.s").write_text(solution.replace("OUT     0", ".rept 99\nNOP\n.endr\nOUT     0"))
    done = test("exercise.s", "--program", class_, "--program", "broken.s", "--junit", "r.xml")
    assert done.exit_code == 2
    assert f"{class_ / 'ann.s'}  1 passed\n" in done.output  # other cycles than the teacher's
    assert "exercise.s:3: expected first == 1, 2, 3; found 2 in frame 0, not 1" in done.output
    assert "golden: frame 0  first  expected 1  found 2" in done.output
    assert "exercise.s:1: expected cycles <= 350; found" in done.output
    assert "broken.s:2:3: error:" in done.output
    assert done.output.endswith("1 passed, 2 failed, 1 error\n")
    root = ET.parse(here / "r.xml").getroot()  # noqa: S314 - our own
    assert [suite.get("name", "").rsplit("/")[-1] for suite in root] == [
        "ann.s", "bob.s", "eve.s", "broken.s",
    ]  # fmt: skip


def test_junit(files: Files) -> None:
    here = files(
        good="; expect: words == 1\n  HALT\n",
        bad="; run: <a>\n; run: b\n".replace("<a>", "a") + "; expect: words < 1\n  HALT\n",
        worse="; expect: x < 1 & \x01 <b>\n  HALT\n",
        none="  HALT\n",
    )
    changed(here / "bad.s", "; run: a\n", "; run: a\n; expect: words >= 9\n")
    done = test("good.s", "bad.s", "worse.s", "--junit", "r.xml")
    assert done.exit_code == 2
    root = ET.parse(here / "r.xml").getroot()  # noqa: S314 - our own
    assert root.tag == "testsuites"
    assert {key: root.get(key) for key in ("tests", "failures", "errors", "skipped")} == {
        "tests": "4", "failures": "2", "errors": "1", "skipped": "0",
    }  # fmt: skip
    assert all(float(item.get("time", "x")) >= 0 for item in root.iter() if "time" in item.keys())  # noqa: SIM118
    failure = root.find("./testsuite[@name='bad.s']/testcase[@name='b']/failure")
    assert failure is not None
    assert failure.get("message") == "bad.s:4: expected words < 1; found 1"
    error = root.find("./testsuite[@name='worse.s']/testcase/error")
    assert error is not None
    assert "unexpected character" in (error.text or "")
    test(here, "--junit", "r.xml")
    root = ET.parse(here / "r.xml").getroot()  # noqa: S314 - our own
    assert root.find(".//skipped") is not None


def test_stop_after_the_first_failure(files: Files) -> None:
    bad = "; run: a\n; expect: words == 9\n; run: b\n; expect: words == 9\n  HALT\n"
    files(a=bad, b=bad)
    done = test("a.s", "b.s", "-x")
    assert done.exit_code == 1
    assert done.output.endswith("0 passed, 1 failed\n")
    assert "b.s  " not in done.output


def test_the_same_mistake_is_told_once_and_long_differences_are_cut(files: Files) -> None:
    runs = "".join(f"; run: r{k} levels=1\n; expect: golden\n" for k in range(12))
    here = files(a=runs + dedent(FIRST_PIXEL))
    test("a.s", "--update")
    changed(here / "a.s", "#ADDED", "#9\nNOP")
    done = test("a.s")
    assert len(done.output.splitlines()) <= 16
    assert "  r0, r1, r2, r3 and 8 more\n" in done.output
    changed(here / "a.s", "NOP", "NPO")
    done = test("a.s")
    assert done.output.count("NPO") == 2  # the message and the line
    assert "12 errors" in done.output


def test_no_colours_and_no_progress_in_a_pipe(files: Files) -> None:
    files(a=GOOD)
    assert "\x1b" not in test("a.s").output
