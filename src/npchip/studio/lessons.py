"""The exercises of the course as examples of the page: one source with page, checks and starter."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from typing import Any, Final

from npchip.course.exercise import Exercise, load_course

_WIDTH: Final = 98
_TEST_LINE: Final = re.compile(r"; (?:run|expect|mistake):")
_PICTURE: Final = re.compile(r"^!\[.*\n?", re.MULTILINE)
_NOTE: Final = "is a lesson: its first lines say what to do, Check says what holds"


def lessons() -> Iterator[dict[str, Any]]:
    """Yield an entry of ``programs/index.json`` for each exercise, in the order of the course."""
    for number, exercise in enumerate(load_course().exercises.values(), start=1):
        main = f"{exercise.name}.s"
        files = {main: _source(exercise)}
        files |= {
            path.name: path.read_text(encoding="utf-8")
            for path in sorted(exercise.folder.glob("*.yaml"))
        }
        yield {
            "name": f"{number:02} {exercise.name}",
            "summary": exercise.title,
            "project": {"main": main, "files": files},
            "clip": exercise.clip,
            "memory": [],
            "note": _NOTE,
            "lesson": True,
        }


def _source(exercise: Exercise) -> str:
    checks = exercise.checks.read_text(encoding="utf-8").splitlines()
    tests = [line for line in checks if _TEST_LINE.match(line)]
    starter = (exercise.folder / "starter.s").read_text(encoding="utf-8")
    body = starter.partition("\n")[2]  # its first line is the title, which the page has
    page = "\n;\n".join(_paragraphs(exercise))
    return "\n".join([page, ";", *tests, "", body])


def _paragraphs(exercise: Exercise) -> Iterator[str]:
    """Yield the page of an exercise as comments; what stands in a fence keeps its lines."""
    fenced = False
    for part in re.split(r"(^```.*\n)", _PICTURE.sub("", exercise.shown_page), flags=re.MULTILINE):
        if part.startswith("```"):
            fenced = not fenced
        elif fenced:
            yield "\n".join(f";     {line}".rstrip() for line in part.splitlines())
        else:
            for paragraph in part.split("\n\n"):
                lines = textwrap.wrap(paragraph.strip(), _WIDTH - 2)
                if lines:
                    yield "\n".join(f"; {line}" for line in lines)
