"""``npchip learn``: the course, from one pixel to a tracker."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from npchip.base.errors import InputError
from npchip.base.files import write_new
from npchip.cli.options import path_option
from npchip.cli.output import emit

if TYPE_CHECKING:
    from npchip.course.exercise import Course, Exercise
    from npchip.course.progress import Progress

FAILED_CHECKS = 3
"""Number of failed checks after which a solution is shown unasked."""


@click.group("learn", invoke_without_command=True)
@path_option(
    "--course",
    "folder",
    metavar="DIR",
    envvar="NPCHIP_COURSE",
    help="Another course: a folder of exercises.",
)
@click.pass_context
def command(ctx: click.Context, folder: Path | None) -> None:
    """Learn to program the chip: exercises with checks, hints and solutions.

    Without a command it lists the course and your progress. Your programs, and the
    progress in npchip-learn.json, are kept in the present folder, or in the one above if you began
    there.

    \b
    Examples:
      npchip learn
      npchip learn start pixel
      npchip learn check           of the exercise that you are in, or started last
      npchip learn hint
    """
    from npchip.course.exercise import load_course

    ctx.obj = load_course(folder)
    if ctx.invoked_subcommand is None:
        from npchip.course.progress import find_progress
        from npchip.course.text import course_text

        emit(course_text(ctx.obj, find_progress()))


def _names(ctx: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    from npchip.course.exercise import load_course

    parent = ctx.parent.params.get("folder") if ctx.parent else None
    return [name for name in load_course(parent).exercises if name.startswith(begun)]


_name = click.argument("name", shell_complete=_names)
_any_name = click.argument("name", required=False, shell_complete=_names)


@command.command("show")
@_any_name
@click.pass_obj
def show(course: Course, name: str | None) -> None:
    """Show the page of an exercise; of the present one without NAME.

    NAME may be the number in the list.
    """
    emit(_exercise(course, name)[0].shown_page)


@command.command("start")
@_name
@click.pass_obj
def start(course: Course, name: str) -> None:
    """Write an exercise into a folder, or go back to one.

    Nothing is overwritten. It is then the present exercise. NAME may be its number in the list.
    """
    from npchip.course.progress import find_progress
    from npchip.course.text import started_text

    exercise, progress = course.need(name), find_progress()
    folder = progress.folder / exercise.name
    again = _present(progress.program(exercise.name))
    files = exercise.handed_out()
    _write(folder, {name: data for name, data in files.items() if not _present(folder / name)})
    progress.record(exercise.name)
    progress.current = exercise.name
    progress.save()
    emit(started_text(exercise, folder, again=again))


@command.command("check")
@click.argument("file", required=False, type=click.Path(path_type=Path))
@click.option("--exercise", "name", metavar="NAME", help="Which exercise FILE is for.")
@click.pass_obj
def check(course: Course, file: Path | None, name: str | None) -> None:
    """Say what holds, what does not, and what to look at.

    FILE belongs to the exercise that it, or its folder, is named after. Without FILE the program of
    the present exercise is checked, which stays the present one. Exits with 0 if it is solved, 1 if
    not yet.
    """
    from npchip.course.check import check as checked
    from npchip.course.text import checked_text

    if file is not None and not _present(file):
        meant = course.find(str(file))
        if meant is None:
            raise _no_program(course, file)
        file, name = None, name or meant.name
    if file is not None and name is None:
        named = (file.stem, file.absolute().parent.name)
        name = next((each for each in named if each in course.exercises), None)
    exercise, progress = _exercise(course, name)
    program = file or progress.program(exercise.name)
    if file is None and _exercise_of_folder(course, progress) == exercise.name:
        program = Path(program.name)
    elif program.is_dir():
        program /= f"{exercise.name}.s"
    if not _present(program):
        raise _no_program(course, program)
    found = checked(exercise, program)
    record = progress.record(exercise.name)
    record.checks += 1
    record.failed += not found.solved
    record.points = max(record.points, found.shown.points)
    record.points_of = found.shown.points_of
    if found.solved and found.hidden:
        record.solved = True
        cycles = found.hidden.cycles or 0
        if not record.cycles or cycles <= record.cycles:
            record.cycles, record.percent = cycles, found.percent or 0
    progress.current = progress.current or exercise.name
    progress.save()
    emit(checked_text(course, exercise, program, found, progress))
    if not found.solved:
        sys.exit(1)


@command.command("hint")
@_any_name
@click.pass_obj
def hint(course: Course, name: str | None) -> None:
    """Show the next hint, and those before it."""
    exercise, progress = _exercise(course, name)
    record, hints = progress.record(exercise.name), exercise.hints
    record.hints = min(record.hints + 1, len(hints))
    progress.save()
    steps = [f"{n} of {len(hints)}: {text}\n" for n, text in enumerate(hints, start=1)]
    emit("\n".join(steps[: record.hints]))
    if record.hints == len(hints):
        emit(f"\nThat was the last hint. Next: npchip learn solution {exercise.name}\n")


@command.command("solution")
@_any_name
@click.option("--now", is_flag=True, help="Also before three checks have failed.")
@click.pass_obj
def solution(course: Course, name: str | None, now: bool) -> None:
    """Show a solution, and what a better one would do."""
    exercise, progress = _exercise(course, name)
    record = progress.record(exercise.name)
    if not (now or record.solved or record.failed >= FAILED_CHECKS):
        left = FAILED_CHECKS - record.failed
        raise InputError(
            "NP664",
            f"the solution of {exercise.name} is shown after {left} more failed"
            f" check{'s' * (left > 1)}",
            hint="npchip learn hint helps; --now shows it at once",
        )
    emit(exercise.shown_solution())


@command.command("copy")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.pass_obj
def copy(course: Course, folder: Path) -> None:
    """Write the whole course into a folder, for teachers.

    It has the hidden checks, the solutions and the wrong answers.
    """
    paths = [path for path in sorted(course.folder.rglob("*")) if path.is_file()]
    _write(folder, {str(path.relative_to(course.folder)): path.read_bytes() for path in paths})
    emit(f"{folder}: {len(course.exercises)} exercises, {len(paths)} files\n")


@command.command("validate")
@click.argument("folders", metavar="DIR...", nargs=-1, type=click.Path(path_type=Path))
@click.pass_obj
def validate(course: Course, folders: tuple[Path, ...]) -> None:
    """Say whether exercises are fit to be handed out.

    Without DIR all of the course are looked at. Exits with 1 if one is not fit.
    """
    from npchip.course.exercise import load_exercise
    from npchip.course.validate import faults

    given = [load_exercise(folder) for folder in folders] or [*course.exercises.values()]
    bad = False
    for exercise in given:
        found = [*faults(exercise)]
        bad = bad or bool(found)
        emit(f"{exercise.name}: {'fit' if not found else f'{len(found)} faults'}\n")
        emit("".join(f"  {text}\n" for text in found))
    if bad:
        sys.exit(1)


def _exercise(course: Course, name: str | None) -> tuple[Exercise, Progress]:
    """Return the exercise that is meant, and the learner's progress.

    Raises:
        InputError: NP661, there is none of this name; NP663, none was begun.
    """
    from npchip.course.progress import find_progress

    progress = find_progress()
    name = name or _exercise_of_folder(course, progress) or progress.current
    if not name:
        first = next(iter(course.exercises))
        raise InputError(
            "NP663", "no exercise was begun in this folder", hint=f"npchip learn start {first}"
        )
    return course.need(name), progress


def _exercise_of_folder(course: Course, progress: Progress) -> str | None:
    """Return the exercise in whose folder the learner is; None elsewhere."""
    name = Path.cwd().name
    is_below = progress.folder.absolute().resolve() == Path.cwd().parent
    return name if is_below and name in course.exercises else None


def _no_program(course: Course, path: Path) -> InputError:
    """Return the error for a program that is not there, with what may be meant."""
    from npchip.course.progress import find_progress

    exercise = course.find(path.stem)
    hint = course.near(path.stem) or "npchip learn lists the exercises"
    if exercise:
        program = find_progress().program(exercise.name)
        hint = f"npchip learn start {exercise.name} writes it"
        if _present(program):
            hint = f"did you mean {program}?"
    return InputError("NP275", f"{path}: no such file or folder", hint=hint)


def _write(folder: Path, files: dict[str, bytes]) -> None:
    targets = {folder / name: data for name, data in files.items()}
    write_new(targets, "remove or rename the folder to begin anew")


def _present(path: Path) -> bool:
    return path.exists() or path.is_symlink()
