"""``npchip test --program DIR``: the table of a class, what submissions may read, whose fault."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from npchip.cli.main import cli

EXERCISE = """\
; expect: words <= 8 points=3
; run: flat levels=1,2,3
; expect: first == 1, 2, 3   points=2
; run: dark levels=0
; expect: first == 0
; expect: status == frames-exhausted ; a remark
"""
SOLUTION = """\
.output first, 0, scalar
.equ ADDED, 0
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        ADD     r0, #ADDED
        OUT     0, r0
        JMP     frame
"""
WRONG = SOLUTION.replace("ADDED, 0", "ADDED, 1")


@pytest.fixture
def class_(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Write the exercise and an empty folder for submissions; return the folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ex.s").write_text(EXERCISE)
    folder = Path("class")
    folder.mkdir()
    return folder


def graded(*arguments: str) -> Result:
    arguments = ("test", "ex.s", "--program", "class", *arguments)
    return CliRunner().invoke(cli, arguments, prog_name="npchip")


def rows(*arguments: str) -> dict[str, dict[str, str]]:
    result = graded("--csv", "out.csv", *arguments)
    assert result.exit_code in {0, 1, 2}, result.output
    with Path("out.csv").open(newline="") as file:
        return {row["submission"]: row for row in csv.DictReader(file)}


def put(path: Path, text: str) -> None:
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)


def test_a_row_a_submission_with_weighed_points(class_: Path) -> None:
    put(class_ / "ann.s", SOLUTION)
    put(class_ / "bob.s", WRONG)
    put(class_ / "eve.s", SOLUTION.replace("OUT", ".rept 9\nNOP\n.endr\nOUT"))
    result = graded("--table")
    assert result.exit_code == 1
    bob = "ex.s:3: expected first == 1, 2, 3; found 2 in frame 0, not 1 (and 2 m"
    eve = "ex.s:1: expected words <= 8; found 15"
    assert result.output.splitlines() == [
        "submission   points  checks  words  cycles  status",
        "class/ann.s     7/7     4/4      6     268  passed",
        f"class/bob.s     4/7     2/4      6     268  failed   {bob}...",
        f"class/eve.s     4/7     3/4     15     277  failed   {eve}",
        "2 passed, 4 failed",
    ]
    assert rows()["class/bob.s"] | {"note": ""} == {
        "submission": "class/bob.s", "points": "4", "points_of": "7", "checks": "2",
        "checks_of": "4", "words": "6", "cycles": "268", "status": "failed", "note": "",
    }  # fmt: skip


def test_everything_handed_in_appears_with_a_word_why_it_was_not_run(class_: Path) -> None:
    """Fails before: what does not end in .s vanished."""
    put(class_ / "ann" / "main.s", f'.include "part.s"\n{SOLUTION}')
    put(class_ / "ann" / "part.s", ".equ UNUSED, 1\n")
    put(class_ / "bob" / "upper.S", SOLUTION)
    put(class_ / "x.asm", SOLUTION)
    put(class_ / "old.npo", "{}")
    put(class_ / ".hidden.s", SOLUTION)
    (class_ / "zoe").mkdir()
    os.mkfifo(class_ / "pipe.s")
    found = rows()
    assert {name: row["note"] for name, row in found.items() if row["status"] == "not run"} == {
        "class/.hidden.s": "hidden",
        "class/ann/part.s": "included by another file",
        "class/bob": "a folder without a .s file",
        "class/bob/upper.S": "its name does not end in .s",
        "class/old.npo": "assembled: hand in the .s source",
        "class/pipe.s": "no file",
        "class/x.asm": "its name does not end in .s",
        "class/zoe": "empty",
    }
    assert found["class/ann/main.s"]["status"] == "passed"
    assert "class/x.asm        not run: its name does not end in .s" in graded().output


@pytest.mark.parametrize("link", ["link.s", "ann/link.s", "ann/deep"])
def test_links_out_of_a_submission_are_not_read(class_: Path, tmp_path: Path, link: str) -> None:
    """Fails before: the text of the file was printed."""
    (tmp_path / "secret").mkdir()
    put(tmp_path / "secret" / "secret.s", "the secret\n")
    put(class_ / "ann" / "main.s", SOLUTION)
    secret = tmp_path / "secret" / ("" if link.endswith("deep") else "secret.s")
    (class_ / link).symlink_to(secret, target_is_directory=secret.is_dir())
    result = graded("--junit", "out.xml")
    assert result.exit_code == 2
    assert "a link that leads out of the submission, not read [NP028]" in result.output
    assert "the secret" not in result.output + Path("out.xml").read_text()
    alone = CliRunner().invoke(cli, ["test", "ex.s", "--program", str(class_ / link)])
    assert "the secret" not in alone.output


def test_includes_reach_no_other_submission(class_: Path) -> None:
    """Fails before: a file could include its neighbour's."""
    put(class_ / "ann.s", SOLUTION)
    put(class_ / "bob.s", '.include "ann.s"\n')
    put(class_ / "cyd.s", '.include "cyd.inc"\n')
    put(class_ / "cyd.inc", '.include "dan/main.s"\n')
    put(class_ / "dan" / "main.s", SOLUTION)
    put(class_ / "eve" / "main.s", '.include "../ann.s"\n')
    put(class_ / "fay" / "main.s", '.include "x/ann.s"\n')
    (class_ / "fay" / "x").symlink_to(class_.resolve(), target_is_directory=True)
    found = rows()
    points = {name: row["points"] for name, row in found.items() if row["points"] not in {"0", ""}}
    assert points == {"class/ann.s": "7", "class/dan/main.s": "7"}
    assert "includes another submission, ann.s" in found["class/bob.s"]["note"]
    assert "includes another submission, main.s" in found["class/cyd.s"]["note"]


def test_links_within_a_submission_are_followed(class_: Path) -> None:
    put(class_ / "ann" / "v2.txt", SOLUTION)
    (class_ / "ann" / "main.s").symlink_to("v2.txt")
    assert rows()["class/ann/main.s"]["points"] == "7"


def test_what_a_submission_lacks_is_its_own_fault(class_: Path) -> None:
    """Fails before: it was reported as an error of the exercise, exit code 2."""
    put(class_ / "ann.s", SOLUTION.replace("first", "frist"))
    result = graded()
    assert result.exit_code == 1
    assert "ex.s:3: expected first == 1, 2, 3; ann has no output 'first'" in result.output
    assert rows()["class/ann.s"]["points"] == "4"  # words and status hold


def test_another_kind_of_output_is_named(class_: Path) -> None:
    """Fails before: it was reported as an error of the exercise."""
    put(class_ / "ann.s", SOLUTION.replace("scalar", "plane"))
    put(class_ / "bob.s", SOLUTION.replace("scalar", "list"))
    result = graded()
    assert "'first' is a list, expected a scalar" in result.output
    Path("ex.s").write_text(EXERCISE + ".output first, 0, scalar\n")
    assert "ex.s:3: expected first == 1, 2, 3; 'first' is a plane, expected a scalar" in (
        graded().output
    )


def test_constants_and_frames_that_do_not_fit_are_the_submissions_fault(class_: Path) -> None:
    """Fails before: both pointed at the exercise, exit code 2."""
    Path("ex.s").write_text("; run: a define=LIMIT=3\n; expect: words < 9\n")
    put(class_ / "ann.s", SOLUTION)
    assert graded().exit_code == 1
    Path("ex.s").write_text("; expect: words < 9\n")
    assert graded().exit_code == 1


def test_a_mistake_of_the_exercise_stays_one(class_: Path) -> None:
    Path("ex.s").write_text("; run: a levels=1\n; expect: status == 3\n")
    put(class_ / "ann.s", SOLUTION)
    result = graded()
    assert result.exit_code == 2
    assert "ex.s:2:11: error: 'status' is a word" in result.output


def test_a_program_with_many_errors_takes_three_lines_of_the_overview(class_: Path) -> None:
    """Fails before: its messages filled the screen."""
    put(class_ / "ann.s", "  NPO\n" * 12)
    result = graded()
    assert result.exit_code == 2
    assert len(result.output.splitlines()) <= 5
    assert "ann.s:1:3: error:" in result.output


@pytest.mark.parametrize(
    "options", [["test", "ex.s", "--table"], ["test", "ex.s", "--csv", "x.csv"]]
)
def test_a_table_needs_submissions(class_: Path, options: list[str]) -> None:
    assert class_.is_dir()
    result = CliRunner().invoke(cli, options)
    assert (result.exit_code, "NP278" in result.output) == (2, True)


@pytest.mark.parametrize("points", ["0", "1001", "x", ""])
def test_points_are_numbers(class_: Path, points: str) -> None:
    put(class_ / "ann.s", SOLUTION)
    Path("ex.s").write_text(f"; expect: words < 9 points={points}\n")
    result = graded()
    assert result.exit_code == 2
    assert "expected points from 1 to 1000" in result.output
    Path("ex.s").write_text("; expect: points=4 words < 2\n; expect: golden outputs points=5\n")
    assert "0/9" in graded("--table").output
