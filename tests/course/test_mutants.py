"""The hidden checks see every instruction that a solution lacks."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from npchip.course.check import judged
from npchip.course.exercise import Exercise, load_course
from tests.support.profiles import THOROUGH

NEEDLESS = {
    "board": {"MOV     r0, #0", "END"},  # AND has left 0 there; HALT needs no END
    "maximum": {"MOV     best, #0"},  # eight shifts have left 0 there
    "motion": {"MOV     seen, #0"},  # a register begins with 0
    "predict": {"MOV     seen, #0"},
}
"""Lines that a solution has for its reader alone."""
_INSTRUCTION = re.compile(r"(?P<label>\.?\w+:)?\s+(?P<text>[A-Z]+\b.*)")
EXERCISES = list(load_course().exercises.values())[:: 1 if THOROUGH else 4]


def without_one(source: str) -> Iterator[tuple[str, str]]:
    """Yield each instruction but EXPOSE with the source that lacks it."""
    lines = source.split("\n")
    for number, line in enumerate(lines):
        found = _INSTRUCTION.match(line)
        if found and found["text"] != "EXPOSE":
            rest = [*lines[:number], found["label"] or "", *lines[number + 1 :]]
            yield found["text"].strip(), "\n".join(rest)


@pytest.mark.long
@pytest.mark.parametrize("exercise", EXERCISES, ids=lambda each: each.name)
def test_no_instruction_can_be_left_out(exercise: Exercise, tmp_path: Path) -> None:
    passed = set()
    mutants = [*without_one(exercise.shown_solution())]
    assert len(mutants) >= 4
    for text, source in mutants:
        path = tmp_path / "mutant.s"
        path.write_text(source)
        if judged(exercise.solution, path).passed:
            passed.add(text)
    assert passed == NEEDLESS.get(exercise.name, set())
