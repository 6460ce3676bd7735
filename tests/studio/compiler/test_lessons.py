"""The lessons of the page are the exercises of the course, and its checks say what is missing."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from npchip.course.exercise import load_course
from npchip.studio.lessons import lessons
from npchip.studio.toolchain.facade import Toolchain
from npchip.testing.cases import cases_of
from npchip.testing.runner import Settings, execute
from npchip.testing.suite import read_suite
from tests.studio.compiler.calls import call, request
from tests.studio.compiler.test_checks import document_of

LESSONS = [*lessons()]
COURSE = load_course()
_TEST_LINE = re.compile(r"^; (?:run|expect|mistake):.*\n", re.MULTILINE)
one_in_six = pytest.mark.parametrize(
    "lesson",
    [
        pytest.param(each, id=each["name"], marks=[pytest.mark.long] * bool(number % 6))
        for number, each in enumerate(LESSONS)
    ],
)


def test_every_exercise_is_a_lesson() -> None:
    assert [each["name"][3:] for each in LESSONS] == [*COURSE.exercises]
    assert all(each["lesson"] and each["note"] for each in LESSONS)
    assert all(len(each["project"]["files"]) < 4 for each in LESSONS)


def verdicts(lesson: dict[str, Any], text: str, folder: Path) -> list[dict[str, Any]]:
    """Return the page's verdicts on all runs of a lesson with another text."""
    project = lesson["project"]
    project = {**project, "files": {**project["files"], project["main"]: text}}
    toolchain = Toolchain(folder / "project")
    for name, content in project["files"].items():
        (folder / name).write_text(content)
    found = call(toolchain, "tests", request(project))
    assert found["diagnostics"] == []
    said: list[dict[str, Any]] = []
    for case in cases_of(read_suite(folder / project["main"])):
        document = document_of(*execute(case, Settings()))
        said += call(toolchain, "judge", case.run.name, case.machine, document)
    return said


@one_in_six
def test_a_lesson_says_what_is_missing_and_when_it_is_done(
    lesson: dict[str, Any], tmp_path: Path
) -> None:
    text = lesson["project"]["files"][lesson["project"]["main"]]
    exercise = COURSE.exercises[lesson["name"][3:]]
    assert all(len(line) <= 100 for line in text.splitlines() if not _TEST_LINE.match(f"{line}\n"))
    begun = verdicts(lesson, text, tmp_path)
    assert any("perhaps: " in each["found"] for each in begun)
    tests = "".join(found[0] for found in _TEST_LINE.finditer(text))
    done = verdicts(lesson, tests + exercise.shown_solution(), tmp_path)
    assert done
    assert [each["found"] for each in done if not each["holds"]] == []
