"""The table of a class: points, checks, words and cycles of each submission."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from typing import NamedTuple

from npchip.base.columns import aligned
from npchip.testing.cases import cases_of
from npchip.testing.harness import Report, Selection
from npchip.testing.report import outcome_lines
from npchip.testing.suite import Suite

MAX_NOTE = 72
"""Most characters of a note in the table; the CSV file has all."""


class Mark(NamedTuple):
    """A row of the table; numbers are None where nothing was run.

    Attributes:
        submission: its path.
        points: sum of the points of the expectations that hold in every run they belong to.
        points_of: sum of all points.
        checks: number of these expectations.
        checks_of: number of all.
        words: length of the program.
        cycles: its worst frame in any run.
        status: ``passed``, ``failed``, ``error`` or ``not run``.
        note: a known mistake, else the first fault, or the reason why it was not run.
    """

    submission: str
    points: int | None
    points_of: int | None
    checks: int | None
    checks_of: int | None
    words: int | None
    cycles: int | None
    status: str
    note: str


def mark(report: Report, suite: Suite, selection: Selection) -> Mark:
    """Return the row of a submission."""
    name = _printable(str(report.program))
    if report.unrun:
        return Mark(name, None, None, None, None, None, None, "not run", report.unrun)
    points: dict[int, int] = {}
    lost: set[int] = set()
    outcomes = {outcome.case.name: outcome for outcome in report.outcomes}
    for case in cases_of(suite, report.program):
        if selection.wants(case):
            own = {claim.span.line.number: claim.points for claim in case.run.claims}
            points |= own
            outcome = outcomes.get(case.name)
            lost |= own.keys() - (outcome.held if outcome else set())
    words = [outcome.words for outcome in report.outcomes if outcome.words is not None]
    cycles = [outcome.cycles for outcome in report.outcomes if outcome.cycles is not None]
    return Mark(
        name,
        sum(value for line, value in points.items() if line not in lost),
        sum(points.values()),
        len(points.keys() - lost),
        len(points),
        max(words, default=None),
        max(cycles, default=None),
        _status(report),
        _note(report),
    )


def table(marks: Sequence[Mark]) -> str:
    """Return the rows as aligned text."""
    rows = [
        (
            each.submission,
            _of(each.points, each.points_of),
            _of(each.checks, each.checks_of),
            _number(each.words),
            _number(each.cycles),
        )
        for each in marks
    ]
    lines = aligned([("submission", "points", "checks", "words", "cycles"), *rows])
    width = max(map(len, lines))
    ends = ["status", *(f"{each.status:<7}  {_short(each.note)}".rstrip() for each in marks)]
    return "".join(f"{line:<{width}}  {end}\n" for line, end in zip(lines, ends, strict=True))


def csv_text(marks: Sequence[Mark]) -> str:
    """Return the rows as CSV, the first one with the names of the columns."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(Mark._fields)
    writer.writerows(marks)
    return stream.getvalue()


def _status(report: Report) -> str:
    return next((state for state in ("error", "failed") if report.count(state)), "passed")


def _note(report: Report) -> str:
    advice = [outcome.advice for outcome in report.outcomes if outcome.advice]
    lines = [line for outcome in report.outcomes for line in outcome_lines(outcome)]
    texts = report.problems + advice + lines
    return _printable(texts[0].split("\n")[0]) if texts else ""


def _printable(text: str) -> str:
    return "".join(char if char.isprintable() else "\N{REPLACEMENT CHARACTER}" for char in text)


def _short(text: str) -> str:
    return text if len(text) <= MAX_NOTE else f"{text[: MAX_NOTE - 3]}..."


def _of(value: int | None, most: int | None) -> str:
    return "" if value is None else f"{value}/{most}"


def _number(value: int | None) -> str:
    return "" if value is None else str(value)
