"""Checks of a learner's program, by the test lines of an exercise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from npchip.course.exercise import Exercise
from npchip.course.places import first_failing, options, place, stop
from npchip.course.tally import Part, Tally, counts, points_of
from npchip.testing.cases import checked_suite
from npchip.testing.compare import table
from npchip.testing.harness import Selection
from npchip.testing.marks import mark
from npchip.testing.runner import Settings
from npchip.testing.submissions import Submission, find_submissions, test_submission


@dataclass(frozen=True)
class Judged:
    """A program judged by one test file.

    Attributes:
        parts: checks on the result, on words and on cycles.
        points: points reached; for words and cycles only where the result is right.
        points_of: all points.
        words: length of the program; None if it was not run.
        cycles: its worst frame in any run; None if it was not run.
        advice: text of the first known mistake that it shows; empty if it shows none.
        faults: all that differs, as text; of an expectation what its first run says.
        passed: whether nothing differs.
        over: whether it takes more cycles than it may.
        stopped: whether a run did not end well.
        where: on which clip, and where in it, the first run that fails does; empty if none does. It
            does not tell what was expected there.
        see: options of `npchip run` that show this run, if it has the clip; files are those of the
            exercise's folder.
    """

    parts: dict[Part, Tally]
    points: int
    points_of: int
    words: int | None
    cycles: int | None
    advice: str
    faults: tuple[str, ...]
    passed: bool
    over: bool
    stopped: bool
    where: str
    see: tuple[str, ...]


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
    def advice(self) -> str:
        """The known mistake: that in the shown checks, else that in the hidden ones."""
        return self.shown.advice or (self.hidden.advice if self.hidden else "")

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
    stopped = False
    for outcome in report.outcomes:
        lines = [*outcome.lines, *table(outcome.differences)]
        if outcome.stopped:
            lines = [] if stopped else [f"{stop(outcome)}: {line}" for line in lines]
            stopped = True
        faults += [line.replace(f"{tests}:", f"{tests.name}:") for line in lines]
    failing = first_failing(report.outcomes)
    found = counts(report)
    return Judged(
        parts={part: each.tally for part, each in found.items()},
        points=points_of(found),
        points_of=row.points_of or 0,
        words=row.words,
        cycles=row.cycles,
        advice=next((outcome.advice for outcome in report.outcomes if outcome.advice), ""),
        faults=_each_once(faults),
        passed=row.status == "passed",
        over=any(outcome.over for outcome in report.outcomes),
        stopped=stopped,
        where=place(failing) if failing else "",
        see=options(failing) if failing else (),
    )


def _each_once(faults: Sequence[str]) -> tuple[str, ...]:
    """Return the first of the faults of each expectation, and the others, each once."""
    found: dict[str, str] = {}
    for fault in faults:
        found.setdefault(fault.partition("; found ")[0], fault)
    return tuple(found.values())
