"""Checks of a learner's program, by the test lines of an exercise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal, NamedTuple

from npchip.course.exercise import Exercise
from npchip.testing.cases import checked_suite
from npchip.testing.claims import Claim
from npchip.testing.harness import Report, Selection
from npchip.testing.marks import mark
from npchip.testing.report import outcome_lines
from npchip.testing.runner import Settings
from npchip.testing.submissions import Submission, find_submissions, test_submission

Part = Literal["result", "words", "cycles"]
PARTS: Final[tuple[Part, ...]] = ("result", "words", "cycles")
_PARTS: Final[dict[str, Part]] = {
    "words": "words",
    "cycles": "cycles",
    "instructions": "cycles",
}


@dataclass(frozen=True)
class Tally:
    """The checks of one part.

    Attributes:
        held: number of those that hold.
        of: number of all.
    """

    held: int = 0
    of: int = 0


class _Counts(NamedTuple):
    held: int
    of: int
    points: int


@dataclass(frozen=True)
class Judged:
    """A program judged by one test file.

    Attributes:
        parts: checks on the result, on words and on cycles.
        points: points reached; for words and cycles only where the result is right.
        points_of: all points.
        words: length of the program; None if it was not run.
        cycles: its worst frame in any run; None if it was not run.
        advice: texts of the known mistakes that it shows, each once.
        faults: all that differs, as text.
        passed: whether nothing differs.
    """

    parts: dict[Part, Tally]
    points: int
    points_of: int
    words: int | None
    cycles: int | None
    advice: tuple[str, ...]
    faults: tuple[str, ...]
    passed: bool


@dataclass(frozen=True)
class Checked:
    """The checks of a learner's program that hold.

    Attributes:
        shown: the checks that the learner has.
        hidden: those on other clips; None where the shown ones do not pass yet.
        reference: the solution by the hidden checks; None where the program does not pass them.
    """

    shown: Judged
    hidden: Judged | None = None
    reference: Judged | None = field(default=None)

    @property
    def solved(self) -> bool:
        """True if all checks pass."""
        return self.hidden is not None and self.hidden.passed

    @property
    def advice(self) -> tuple[str, ...]:
        """Known mistakes: those in the shown checks, else those in the hidden ones."""
        return self.shown.advice or (self.hidden.advice if self.hidden else ())

    @property
    def percent(self) -> int | None:
        """The program's cycles in percent of the solution's, rounded up; None unless solved."""
        if not (self.solved and self.hidden and self.reference):
            return None
        if not self.hidden.cycles or not self.reference.cycles:
            return None
        return -(-100 * self.hidden.cycles // self.reference.cycles)


def check(exercise: Exercise, program: Path, settings: Settings | None = None) -> Checked:
    """Check a program: by the shown checks, and if it passes by the hidden ones.

    Raises:
        NpchipError: the test lines of the exercise cannot be read; NP275, there is no such program.
    """
    shown = judged(exercise.checks, program, settings)
    if not shown.passed:
        return Checked(shown)
    hidden = judged(exercise.solution, program, settings)
    if not hidden.passed:
        return Checked(shown, hidden)
    return Checked(shown, hidden, judged(exercise.solution, exercise.solution, settings))


def judged(tests: Path, program: Path, settings: Settings | None = None) -> Judged:
    """Judge a program by the test lines of a file; errors as for `check`."""
    suite, selection = checked_suite(tests), Selection()
    given = Submission(program) if program == tests else find_submissions([program])[0]
    report = test_submission(suite, given, settings or Settings(), selection)
    row = mark(report, suite, selection)
    faults = [*report.problems, *[f"not run: {report.unrun}"] * bool(report.unrun)]
    for outcome in report.outcomes:
        lines = outcome_lines(outcome)[len(outcome.advice) :]
        faults += [line.replace(f"{tests}:", f"{tests.name}:") for line in lines]
    advice = [text for outcome in report.outcomes for text in outcome.advice]
    parts = _tallies(report)
    return Judged(
        {part: Tally(*counts[:2]) for part, counts in parts.items()},
        _points(parts),
        row.points_of or 0,
        row.words,
        row.cycles,
        _each_once(advice),
        _each_once(faults),
        row.status == "passed",
    )


def _points(parts: dict[Part, _Counts]) -> int:
    result = parts["result"]
    right = result.held == result.of
    return sum(each.points for part, each in parts.items() if right or part == "result")


def _tallies(report: Report) -> dict[Part, _Counts]:
    """Count the lines that hold in every run that they belong to."""
    parts: dict[int, Part] = {}
    points: dict[int, int] = {}
    lost: set[int] = set()
    for outcome in report.outcomes:
        for claim in outcome.case.run.claims:
            line = claim.span.line.number
            named = claim.name if isinstance(claim, Claim) else ""
            parts[line] = _PARTS.get(named, "result")
            points[line] = claim.points
            if line not in outcome.held:
                lost.add(line)
    found: dict[Part, _Counts] = {}
    for part in PARTS:
        own = {line for line, each in parts.items() if each == part}
        found[part] = _Counts(len(own - lost), len(own), sum(points[line] for line in own - lost))
    return found


def _each_once(texts: Sequence[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(texts))
