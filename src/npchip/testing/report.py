"""Reports as text: a line for each program, and the faults of those that fail."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from shlex import quote

from npchip.testing.compare import MAX_LINES, table
from npchip.testing.golden import golden_path
from npchip.testing.harness import Report
from npchip.testing.runner import Outcome

MIN_LINES = 3
"""Fewest shown for a run, if it has as many."""

STATES = ("passed", "failed", "error")
_COLOURS = ("green", "red", "red")

Paint = Callable[[str, str], str]
"""Returns a text in a colour, given by name."""


def plain(text: str, _colour: str) -> str:
    """Return a text without colour."""
    return text


def report_text(
    report: Report, width: int = 0, paint: Paint = plain, *, brief: bool = False
) -> str:
    """Return a line with the counts, then the faults.

    Args:
        report: the report of one program.
        width: width of the longest program's name, to align the counts.
        paint: colours texts.
        brief: show one line of a program that does not assemble.
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
        said = outcome_lines(group[0])
        if brief and group[0].state == "error":
            said = [text.split("\n")[0] for text in said]
            share = 2 + bool(group[0].advice)
        lines += _indented(_cut(said, share), "    ")
    more = [name for group in groups[MAX_LINES // MIN_LINES :] for name in _names(group)]
    if more:
        lines.append(f"  and {len(more)} more: {_few(more)}")
    return "\n".join(lines) + "\n"


def outcome_lines(outcome: Outcome) -> list[str]:
    """Return the faults of a run: a known mistake, expectations, differences from the golden."""
    advice = [f"perhaps: {outcome.advice}"] * bool(outcome.advice)
    costs = [costs_hint(outcome.case.program)] * outcome.over
    return advice + outcome.lines + table(outcome.differences) + costs


def costs_hint(program: Path) -> str:
    """Return where the cycles of each line of a program are shown."""
    return f"npchip asm {quote(str(program))} --listing shows what each line costs"


def outcome_text(outcome: Outcome) -> str:
    """Return the faults of a run as text, as long as the report of a program at most."""
    return "\n".join(_cut(outcome_lines(outcome), MAX_LINES))


def summary(reports: Sequence[Report], paint: Paint = plain) -> str:
    """Return ``N passed, N failed``, and the other counts that are not 0."""
    totals = [sum(report.count(state) for report in reports) for state in STATES]
    parts = _numbers(totals, paint, always=2)
    untested = sum(report.untested for report in reports)
    skipped = sum(report.skipped for report in reports)
    unrun = sum(bool(report.unrun) for report in reports)
    others = ((unrun, "not run"), (untested, "without tests"), (skipped, "not selected"))
    return ", ".join(parts + [f"{count} {text}" for count, text in others if count]) + "\n"


def _counts(report: Report, paint: Paint) -> str:
    if report.unrun:
        return paint(f"not run: {report.unrun}", "yellow")
    if report.untested:
        return paint("no tests", "yellow")
    return ", ".join(_numbers([report.count(state) for state in STATES], paint))


def _numbers(counts: Sequence[int], paint: Paint, always: int = 0) -> list[str]:
    """Return the counts of `STATES` as words: those that are not 0, and the first `always`."""
    words = ("passed", "failed", f"error{'s' * (counts[-1] > 1)}")
    colours = [colour if count else "" for colour, count in zip(_COLOURS, counts, strict=True)]
    return [
        paint(f"{count} {word}", colour)
        for index, (count, word, colour) in enumerate(zip(counts, words, colours, strict=True))
        if count or index < always
    ]


def _groups(outcomes: Sequence[Outcome]) -> list[list[Outcome]]:
    """Return the runs that failed, grouped by their faults."""
    groups: dict[tuple[str, ...], list[Outcome]] = {}
    for outcome in outcomes:
        if outcome.state != "passed":
            groups.setdefault(tuple(outcome_lines(outcome)), []).append(outcome)
    return list(groups.values())


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
    """Return the width of the longest name; 0 without programs."""
    return max((len(str(program)) for program in programs), default=0)
