"""Texts for a learner: the list of the course, and what a check found."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path

from npchip.base.columns import aligned
from npchip.course.check import Checked, Judged
from npchip.course.exercise import Course, Exercise
from npchip.course.progress import Progress, Record
from npchip.course.tally import PARTS, Part
from npchip.testing.report import costs_hint

_ON_OTHERS = {True: "holds, on other clips too", False: "fails on other clips"}
MAX_FAULTS = 4
"""Most faults that are shown of one check."""


def course_text(course: Course, progress: Progress) -> str:
    """Return the list of the exercises with what was reached in each, and what to do next."""
    rows = []
    for number, (name, exercise) in enumerate(course.exercises.items(), start=1):
        mark = ">" if name == progress.current else " "
        reached = _reached(progress.records.get(name))
        rows.append((f"{mark}{number:>3}", name, exercise.title, reached))
    solved = sum(map(progress.solved, course.exercises))
    lines = [f"{len(rows)} exercises, {solved} solved", "", *aligned(rows, left=4), ""]
    return "\n".join([*lines, _next(course, progress)]) + "\n"


def _reached(record: Record | None) -> str:
    if record is None:
        return ""
    if record.solved:
        return f"solved, {record.percent} % of the solution's cycles"
    if record.checks:
        return f"{record.points} of {record.points_of} points"
    return "begun"


def _next(course: Course, progress: Progress) -> str:
    """Return the next step: the present exercise, else the next one that is not solved."""
    names = [*course.exercises]
    current = progress.current
    if current in progress.records and current in names:
        if not progress.solved(current):
            return f"Next: change {progress.program(current)}, then npchip learn check"
        at = names.index(current)
        names = names[at:] + names[:at]
    for name in names:
        if not progress.solved(name):
            return f"Next: npchip learn start {name}"
    return (
        "All are solved. Can you need fewer cycles? Or write a program of your own: npchip run FILE"
    )


def started_text(exercise: Exercise, folder: Path, *, again: bool) -> str:
    """Return what to do with an exercise in a folder; `again` if it was there already."""
    place = f"{folder}: page.md says what to do, {exercise.name}.s is where you do it"
    if again:
        place = f"{folder}: back again; {exercise.name}.s is as you left it"
    return (
        f"{place}\n\n"
        f"{exercise.shown_page}\n"
        f"Next: change {folder / exercise.name}.s, then npchip learn check\n"
    )


def checked_text(
    course: Course, exercise: Exercise, program: Path, found: Checked, progress: Progress
) -> str:
    """Return what holds and what does not, and what to look at."""
    shown, hidden = found.shown, found.hidden
    lines = [f"{program}: {shown.points} of {shown.points_of} points"]
    lines += [_part_line(part, shown) for part in PARTS if shown.parts[part].of]
    if hidden is not None and exercise.drawn:  # one without a clip has no others
        lines.append(f"  {'clips':<7} {_ON_OTHERS[hidden.passed]}")
    if found.advice:
        lines.append(f"  perhaps: {found.advice}")
    faults = shown.faults[:MAX_FAULTS]
    lines += [f"  {line}" for text in faults for line in text.splitlines()]
    more = len(shown.faults) - len(faults)
    if more:
        lines.append(f"  and {more} more")
    if shown.over:
        lines.append(f"  {costs_hint(program)}")
    if hidden is not None and not hidden.passed:
        lines.append(f"  {hidden.where}")
        lines.append("  It must be right for every clip, not for those of checks.s alone.")
        if hidden.see:
            lines.append(f"  See it: {_run(program, hidden.see, exercise)}")
    if found.percent is not None and hidden and found.reference:
        cycles = _beside(hidden.cycles, found.reference.cycles, "cycles")
        words = _beside(hidden.words, found.reference.words, "words")
        lines.append(f"  compare {cycles} ({found.percent} %); {words}")
    lines += _after_check(course, exercise, program, found, progress)
    return "\n".join(lines) + "\n"


def _beside(own: int | None, others: int | None, unit: str) -> str:
    """Return a number beside that of the solution, and which of the two is smaller."""
    own, others = own or 0, others or 0
    if own == others:
        return f"{own:,} {unit}, as many as the solution"
    return f"{own:,} {unit}, {'fewer' if own < others else 'more'} than the solution's {others:,}"


def _part_line(part: Part, judged: Judged) -> str:
    tally = judged.parts[part]
    value = {"words": judged.words, "cycles": judged.cycles}.get(part)
    why = "the run stopped" if judged.stopped else "the program was not run"
    if tally.unjudged == tally.of:
        return f"  {part:<7} not judged, {why}"
    held = "holds" if tally.held == tally.of else f"{tally.held} of {tally.of} checks hold"
    if tally.unjudged:
        held += f", {tally.unjudged} not judged: {why}"
    return f"  {part:<7} {held}" + (f" ({value:,})" if value is not None else "")


def _after_check(
    course: Course, exercise: Exercise, program: Path, found: Checked, progress: Progress
) -> list[str]:
    if not found.solved:
        present = exercise.name == progress.current
        name = "" if present else f" {exercise.name}"
        return [f"Look at: npchip learn hint{name}, npchip learn show{name}"]
    return [
        "Solved.",
        f"See it: {_run(program, exercise.drawn, exercise)}",
        _next(course, progress),
    ]


def _run(program: Path, options: Sequence[str], exercise: Exercise) -> str:
    """Return the command that draws what a program does; files are those beside the program."""
    files = {name: str(program.parent / name) for name in exercise.handed_out()}
    given = [files.get(option, option) for option in options]
    run = ["npchip", "run", str(program), *given, "--render", f"{exercise.name}.png"]
    return shlex.join(run)
