"""What a learner reads: the list of the course, and what a check found."""

from __future__ import annotations

from pathlib import Path

from npchip.base.columns import aligned
from npchip.course.check import PARTS, Checked, Judged
from npchip.course.exercise import Course, Exercise
from npchip.course.progress import Progress, Record

MAX_FAULTS = 4
"""Most faults that are shown of one check."""


def course_text(course: Course, progress: Progress) -> str:
    """Return the list of the exercises with what was reached in each, and what to do next."""
    rows = []
    for number, (name, exercise) in enumerate(course.exercises.items(), start=1):
        mark = ">" if name == progress.current else " "
        reached = _reached(progress.records.get(name))
        rows.append((f"{mark}{number:>3}", name, exercise.title, reached))
    solved = sum(progress.records[name].solved for name in rows_begun(course, progress))
    lines = [f"{len(rows)} exercises, {solved} solved", "", *aligned(rows, left=4), ""]
    return "\n".join([*lines, _next(course, progress)]) + "\n"


def rows_begun(course: Course, progress: Progress) -> list[str]:
    """Return the names of the exercises of a course that were begun."""
    return [name for name in course.exercises if name in progress.records]


def _reached(record: Record | None) -> str:
    if record is None:
        return ""
    if record.solved:
        return f"solved, {record.percent} % of the solution's cycles"
    if record.checks:
        return f"{record.points} of {record.points_of} points"
    return "begun"


def _next(course: Course, progress: Progress) -> str:
    current = progress.records.get(progress.current)
    if current and not current.solved and progress.current in course.exercises:
        return "Next: npchip learn check"
    for name in course.exercises:
        if not (name in progress.records and progress.records[name].solved):
            return f"Next: npchip learn start {name}"
    return "All are solved. Can you need fewer cycles?"


def started_text(exercise: Exercise, folder: Path) -> str:
    """Return what to do with an exercise that was written into a folder."""
    return (
        f"{folder}: page.md says what to do, {exercise.name}.s is where you do it\n\n"
        f"{exercise.shown_page}\n"
        f"Next: change {folder / exercise.name}.s, then npchip learn check\n"
    )


def checked_text(exercise: Exercise, program: Path, found: Checked, after: Exercise | None) -> str:
    """Return what holds and what does not, and what to look at."""
    shown, hidden = found.shown, found.hidden
    lines = [f"{program}: {shown.points} of {shown.points_of} points"]
    lines += [_part_line(part, shown) for part in PARTS if shown.parts[part].of]
    if hidden is not None:
        lines.append(f"  {'hidden':<7} {'holds' if hidden.passed else 'not on other clips'}")
    lines += [f"  perhaps: {text}" for text in found.advice[:MAX_FAULTS]]
    faults = shown.faults[:MAX_FAULTS]
    lines += [f"  {line}" for text in faults for line in text.splitlines()]
    more = len(shown.faults) - len(faults)
    if more:
        lines.append(f"  and {more} more")
    if hidden is not None and not hidden.passed:
        lines.append("  It must be right for every clip, not for those of checks.s alone.")
    if found.percent is not None and hidden and found.reference:
        lines.append(
            f"  leader  {hidden.cycles:,} cycles, {found.percent} % of the solution's"
            f" {found.reference.cycles:,}; {hidden.words} words, the solution has"
            f" {found.reference.words}"
        )
    lines.append(_after_check(exercise, found, after))
    return "\n".join(lines) + "\n"


def _part_line(part: str, judged: Judged) -> str:
    tally = judged.parts[part]  # type: ignore[index]
    value = {"words": judged.words, "cycles": judged.cycles}.get(part)
    held = "holds" if tally.held == tally.of else f"{tally.held} of {tally.of} checks hold"
    return f"  {part:<7} {held}" + (f" ({value:,})" if value is not None else "")


def _after_check(exercise: Exercise, found: Checked, after: Exercise | None) -> str:
    if not found.solved:
        return f"Look at: npchip learn hint, npchip learn show {exercise.name}"
    if after is None:
        return "Solved, and this was the last exercise."
    return f"Solved. Next: npchip learn start {after.name}"
