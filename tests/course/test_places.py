"""Of every exercise: the clip to look at, and where a program fails on clips that stay hidden."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from npchip import load_machine
from npchip.assembler import assemble
from npchip.assembler.diagnostics import AssemblyError
from npchip.course.check import Checked, check
from npchip.course.exercise import Exercise, load_course
from npchip.course.progress import find_progress
from npchip.course.tally import PARTS
from npchip.course.text import checked_text
from npchip.testing.suite import read_suite

COURSE = load_course()
EXERCISES = [*COURSE.exercises.values()]
_DRAWN = re.compile(r"<!-- npchip run \w+\.s (.*)--render picture\.png -->")
_PLACE = re.compile(r"(?P<clip>[\w., ]+): (?P<what>[\w ]+) in (?:frame \d+|the setup)\b")

each_exercise = pytest.mark.parametrize("exercise", EXERCISES, ids=lambda each: each.name)
one_in_six = pytest.mark.parametrize(
    "exercise",
    [
        pytest.param(each, id=each.name, marks=[pytest.mark.long] * bool(number % 6))
        for number, each in enumerate(EXERCISES)
    ],
)


def said(exercise: Exercise, program: Path, found: Checked) -> str:
    return checked_text(COURSE, exercise, program, found, find_progress())


@one_in_six
def test_see_it_shows_the_clip_of_the_page(
    exercise: Exercise, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = Path(exercise.name)
    folder.mkdir()
    for name, data in exercise.handed_out().items():
        (folder / name).write_bytes(data)
    program = folder / f"{exercise.name}.s"
    shutil.copy(exercise.solution, program)
    text = said(exercise, program, check(exercise, program))
    (see,) = (line for line in text.splitlines() if line.startswith("See it: "))
    drawn = _DRAWN.search(exercise.page)
    assert drawn is not None
    options = see.split()[5:-2]
    assert [Path(each).name for each in options] == drawn[1].split()
    for shown in options:
        assert "." not in shown or Path(shown).is_file()


def noise(exercise: Exercise, machine: str) -> float:
    is_file = machine.endswith(".yaml")
    return load_machine(exercise.folder / machine if is_file else machine).sensor.noise_rms


@each_exercise
def test_hidden_runs_are_recorded_but_those_with_noise(exercise: Exercise) -> None:
    """Of a recorded run the frame that differs can be named; noise depends on the conversions."""
    suite = read_suite(exercise.solution)
    shown = {run.name for run in read_suite(exercise.checks).runs}
    hidden = [run for run in suite.runs if run.name not in shown]
    for run in hidden:
        noisy = any(noise(exercise, machine) for machine in run.machines)
        assert run.golden_outputs != noisy, run.name
    assert not hidden or any(run.golden_outputs for run in hidden)


@pytest.mark.parametrize("signal_first", [False, True])
def test_pixels_may_be_converted_in_either_order(*, signal_first: bool, tmp_path: Path) -> None:
    exercise = COURSE.exercises["cds"]
    lines = exercise.shown_solution().splitlines()
    first, second = (number for number, line in enumerate(lines) if "SAMPLE" in line)
    if signal_first:
        lines[first], lines[second] = lines[second], lines[first]
    path = tmp_path / "cds.s"
    path.write_text("\n".join(lines) + "\n")
    found = check(exercise, path)
    assert found.solved, found.hidden


@one_in_six
def test_what_fails_on_other_clips_has_a_place(exercise: Exercise, tmp_path: Path) -> None:
    """A program that passes the shown checks, which ask for nothing here, fails the hidden ones."""
    copy = tmp_path / exercise.folder.name
    shutil.copytree(exercise.folder, copy)
    run = "; run: any" if exercise.name == "board" else "; run: any levels=0"
    (copy / "checks.s").write_text(f"; expect: words >= 1\n{run}\n; expect: cycles >= 1\n")
    lenient = Exercise(copy, exercise.name)
    program = _wrong_on_a_clip(exercise, tmp_path)
    found = check(lenient, program)
    assert found.shown.passed
    assert found.hidden is not None
    assert not found.hidden.passed
    assert "expected" not in found.hidden.where
    assert _PLACE.match(found.hidden.where), found.hidden.where
    lines = said(lenient, program, found).splitlines()
    assert f"  {found.hidden.where}" in lines
    if found.hidden.see:
        options = found.hidden.see[:2]
        if exercise.name == "cds":
            options = (*options, "--machine", f"{program.parent}/uneven.yaml")
        see = f"npchip run {program} {' '.join(options)} --render {exercise.name}.png"
        assert f"  See it: {see}" in lines


def _wrong_on_a_clip(exercise: Exercise, folder: Path) -> Path:
    """Return the solution with an output that is always 0, or is not sent at all."""
    path = folder / "wrong.s"
    text = exercise.shown_solution()
    path.write_text(re.sub(r"(OUT +\d+, )\w+", r"\1r15", text))
    try:
        assemble(path)
    except AssemblyError as error:
        pytest.fail(str(error))
    return path


def test_a_run_that_stops_leaves_its_checks_unjudged_but_those_on_words(tmp_path: Path) -> None:
    exercise = COURSE.exercises["tally"]
    path = tmp_path / "tally.s"
    path.write_text(re.sub(r" +(?:WHERE|END).*\n", "", exercise.shown_solution()))
    found = check(exercise, path)
    assert [found.shown.parts[part].unjudged for part in PARTS] == [3, 0, 1]
    lines = said(exercise, path, found).splitlines()
    assert lines[1:4] == [
        "  result  not judged, the run stopped",
        "  words   holds (50)",
        "  cycles  not judged, the run stopped",
    ]
    faults = [line for line in lines if "NP310" in line]
    assert len(faults) == 1
    assert faults[0].startswith("  frames of grey 100, 99, 100, frame 0: ")


def test_what_does_not_assemble_is_not_judged(tmp_path: Path) -> None:
    exercise = COURSE.exercises["pixel"]
    path = tmp_path / "pixel.s"
    path.write_text("frame: EXPOS\n")
    lines = said(exercise, path, check(exercise, path)).splitlines()
    for part, line in zip(PARTS, lines[1:4], strict=True):
        assert line == f"  {part:<7} not judged, the program was not run"
