"""Checks that an exercise is fit to be handed out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from npchip.course.check import check, judged
from npchip.course.exercise import Exercise
from npchip.testing.runner import Settings

MAX_WORDS = 300
MIN_WRONG = 3
MIN_HINTS = 2
_PICTURE = re.compile(r"!\[[^\]]+\]\((?P<file>[\w.-]+)\)")
_FIRST = re.compile(r"; ?(?P<said>.*)")


def faults(exercise: Exercise, settings: Settings | None = None) -> Iterator[str]:
    """Yield what is wrong with an exercise; nothing if it is fit.

    Raises:
        NpchipError: a file cannot be read, or its test lines have mistakes.
    """
    yield from _faults_of_page(exercise)
    yield from _faults_of_solution(exercise, settings)
    starter = check(exercise, exercise.folder / "starter.s", settings)
    if starter.shown.passed:
        yield "starter.s passes the checks: there is nothing left to do"
    elif not starter.advice:
        yield "starter.s fails without a helpful word: a '; mistake:' line in checks.s gives one"
    if len(exercise.wrong) < MIN_WRONG:
        yield f"wrong/ has {len(exercise.wrong)} answers, fewer than {MIN_WRONG}"
    for path in exercise.wrong:
        yield from _faults_of_wrong(exercise, path, settings)


def _faults_of_page(exercise: Exercise) -> Iterator[str]:
    page = exercise.shown_page
    words = len(page.split())
    if words > MAX_WORDS:
        yield f"page.md has {words} words, more than {MAX_WORDS}"
    if not page.startswith("# "):
        yield "page.md does not begin with a heading"
    pictures = [found["file"] for found in _PICTURE.finditer(page)]
    if not pictures:
        yield "page.md shows no picture"
    if not exercise.is_drawn:
        comment = "<!-- npchip run solution.s --frames CLIP --render picture.png -->"
        yield f"page.md does not say what draws its picture: {comment}"
    yield from (
        f"page.md shows {name}, which is not there"
        for name in pictures
        if not (exercise.folder / name).is_file()
    )
    if len(exercise.hints) < MIN_HINTS or not all(exercise.hints):
        yield f"hints.md has fewer than {MIN_HINTS} steps, with a line --- between them"


def _faults_of_solution(exercise: Exercise, settings: Settings | None) -> Iterator[str]:
    for tests in (exercise.checks, exercise.solution):
        found = judged(tests, exercise.solution, settings)
        if not found.passed:
            yield f"solution.s fails {tests.name}: {found.faults[0]}"
    if exercise.unrepeated:
        yield f"solution.s lacks a test line of checks.s: {exercise.unrepeated[0]}"
    parts = judged(exercise.checks, exercise.solution, settings).parts
    yield from (f"checks.s says nothing on {part}" for part, tally in parts.items() if not tally.of)
    if not exercise.shown_solution().startswith(";"):
        yield "solution.s does not begin with a remark"


def _faults_of_wrong(exercise: Exercise, path: Path, settings: Settings | None) -> Iterator[str]:
    first = _FIRST.match(path.read_text(encoding="utf-8"))
    wanted = first["said"].strip() if first else ""
    found = check(exercise, path, settings)
    if found.solved:
        yield f"wrong/{path.name} passes all checks"
    elif not wanted or wanted != found.advice:
        said = found.advice or "nothing"
        yield f"wrong/{path.name}: its first line says '{wanted}', the checks say '{said}'"
