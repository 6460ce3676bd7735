"""Reports as text: a line for a program that passes, what differs for one that does not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from npchip.testing.compare import Difference
from npchip.testing.golden import golden_path
from npchip.testing.runner import Outcome
from npchip.testing.harness import Report

MAX_LINES = 10
"""Most differences or mistakes that are shown of one program; a mistake has several lines."""

MIN_LINES = 3
"""As many are shown of a run, if there are any."""

STATES = ("passed", "failed", "error")
_COLOURS = ("green", "red", "red")

Paint = Callable[[str, str], str]
"""Colours a text; the second argument is the name of the colour."""


def plain(text: str, _colour: str) -> str:
    """Paint nothing."""
    return text


def report_text(report: Report, width: int = 0, paint: Paint = plain) -> str:
    """A line with the counts, then what differs.

    Args:
        report: of one program.
        width: of the longest program's name, so that counts stand below each other.
        paint: for terminals.
    """
    lines = [f"{report.program!s:<{width}}  {_counts(report, paint)}".rstrip()]
    if report.updated:
        path = golden_path(report.program)
        lines.append(paint(f"  {path.name} updated: {_few(report.updated)}", "yellow"))
    lines += _indented(_cut(report.problems, MAX_LINES), "  ")
    groups = _groups(report.outcomes)
    share = max(MAX_LINES // max(1, len(groups)), MIN_LINES)
    for group in groups[: MAX_LINES // MIN_LINES]:
        lines.append(f"  {paint(_few(_names(group)), 'bold')}")
        lines += _indented(_cut(outcome_lines(group[0]), share), "    ")
    more = [name for group in groups[MAX_LINES // MIN_LINES :] for name in _names(group)]
    if more:
        lines.append(f"  and {len(more)} more: {_few(more)}")
    return "\n".join(lines) + "\n"


def outcome_lines(outcome: Outcome) -> list[str]:
    """List what is wrong with a run: expectations first, then differences from the golden."""
    return outcome.lines + _table(outcome.differences)


def outcome_text(outcome: Outcome) -> str:
    """As `outcome_lines`, no longer than the report of a program."""
    return "\n".join(_cut(outcome_lines(outcome), MAX_LINES))


def summary(reports: Sequence[Report], paint: Paint = plain) -> str:
    """``N passed, N failed``, and what else there is to say."""
    totals = [sum(report.count(state) for report in reports) for state in STATES]
    parts = _numbers(totals, paint, always=2)
    untested = sum(report.untested for report in reports)
    if untested:
        parts.append(f"{untested} without tests")
    skipped = sum(report.skipped for report in reports)
    if skipped:
        parts.append(f"{skipped} not selected")
    return ", ".join(parts) + "\n"


def _counts(report: Report, paint: Paint) -> str:
    if report.untested:
        return paint("no tests", "yellow")
    return ", ".join(_numbers([report.count(state) for state in STATES], paint))


def _numbers(counts: Sequence[int], paint: Paint, always: int = 0) -> list[str]:
    """Say how many runs there are of each of `STATES`; of the first, also that there are none."""
    words = ("passed", "failed", f"error{'s' * (counts[-1] > 1)}")
    colours = [colour if count else "" for colour, count in zip(_COLOURS, counts, strict=True)]
    return [
        paint(f"{count} {word}", colour)
        for index, (count, word, colour) in enumerate(zip(counts, words, colours, strict=True))
        if count or index < always
    ]


def _groups(outcomes: Sequence[Outcome]) -> list[list[Outcome]]:
    """Failed runs; those of which the same is to be said, such as a syntax error, together."""
    groups: dict[tuple[str, ...], list[Outcome]] = {}
    for outcome in outcomes:
        if outcome.state != "passed":
            groups.setdefault(tuple(outcome_lines(outcome)), []).append(outcome)
    return list(groups.values())


def _table(differences: Sequence[Difference]) -> list[str]:
    rows = [
        (
            f"golden: {difference.where}" if difference.where else "golden:",
            difference.what,
            difference.expected,
            difference.found,
            difference.note,
        )
        for difference in differences
    ]
    if not rows:
        return []
    shown = rows[:MAX_LINES]
    where, what, expected, found = (max(len(row[column]) for row in shown) for column in range(4))
    return [
        f"{a:<{where}}  {b:<{what}}  expected {c:>{expected}}  found {d:>{found}}  {e}".rstrip()
        for a, b, c, d, e in rows
    ]


def _cut(lines: Sequence[str], most: int) -> list[str]:
    if len(lines) <= most:
        return list(lines)
    return [*lines[: most - 1], f"and {len(lines) - most + 1} more"]


def _indented(texts: Sequence[str], margin: str) -> list[str]:
    return [f"{margin}{line}" for text in texts for line in text.splitlines()]


def _names(group: Sequence[Outcome]) -> list[str]:
    return [outcome.case.name for outcome in group]


def _few(names: Sequence[str]) -> str:
    more = len(names) - 4
    return ", ".join(names[:4]) + (f" and {more} more" if more > 0 else "")


def longest(programs: Sequence[Path]) -> int:
    """Width of the longest name."""
    return max((len(str(program)) for program in programs), default=0)
