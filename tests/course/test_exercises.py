"""Every exercise of the course is fit, and its solution is what NumPy says."""

from __future__ import annotations

import re
import shutil
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from npchip import Chip, assemble
from npchip.assembler.diagnostics import AssemblyError, Diagnostic
from npchip.bundle import bundled
from npchip.cli.main import cli
from npchip.course.exercise import Exercise, load_course
from npchip.course.validate import faults
from npchip.isa import load_isa
from npchip.testing.cases import checked_suite
from tests.course.oracles import ORACLES, Clip

COURSE = load_course()
EXERCISES = [*COURSE.exercises.values()]
FRAMES = slice(1, None, 7)
CLIPS = ("mouse_run", "coin_slide", "shapes_photo", "shapes_drawn")
_SHOWN = re.compile(r"^(?:[a-z]\w*:|\.\w+:)?\s+([A-Z]+)\b", re.MULTILINE)
_SNIPPET = re.compile(r"^```asm\n(.*?)^```", re.MULTILINE | re.DOTALL)
_REGISTER = re.compile(r"(?:\w+:|\.\w+:)?\s+[A-Z]{2,}\s+(?:#?\d+, )?(?P<name>[a-z]\w*),? ?")
_EXAMPLE = {"a", "b", "found", "frame", "largest", "signal", "reset"}
"""Names that stand for another one, labels, and operands that are none."""
_COMMAND = re.compile(r"<!-- npchip (run \w+\.s .*--render picture\.png) -->")

one_in_six = pytest.mark.parametrize(
    "exercise",
    [
        pytest.param(each, id=each.name, marks=[pytest.mark.long] * bool(number % 6))
        for number, each in enumerate(EXERCISES)
    ],
)
each_exercise = pytest.mark.parametrize("exercise", EXERCISES, ids=lambda each: each.name)


def test_the_course_goes_from_one_pixel_to_budgets() -> None:
    assert [*COURSE.exercises] == [*ORACLES]
    assert [each.folder.name[:2] for each in EXERCISES] == [f"{n:02}" for n in range(1, 25)]


@one_in_six
def test_an_exercise_is_fit(exercise: Exercise) -> None:
    """Starter, solution and wrong answers get what they should; the page is short."""
    assert [*faults(exercise)] == []


@each_exercise
def test_sources_are_clean(exercise: Exercise) -> None:
    """The solution assembles without a warning; a wrong answer has no error but an open WHERE."""
    warnings: list[Diagnostic] = []
    assemble(exercise.solution, on_warning=warnings.append)
    assert warnings == []
    codes = set()
    for path in exercise.wrong:
        with suppress(AssemblyError):
            assemble(path)
            continue
        with pytest.raises(AssemblyError) as error:
            assemble(path)
        codes |= {each.code for each in error.value.diagnostics}
    assert codes <= {"NP020"}


@each_exercise
def test_the_solution_is_what_numpy_says(exercise: Exercise) -> None:
    machines = sorted(exercise.folder.glob("uneven.yaml"))
    chip = Chip(assemble(exercise.solution), machines[0] if machines else "default")
    if exercise.name == "board":
        result, clip = chip.run(None), np.zeros((0, 64, 80), np.uint8)
        sent = {name: np.asarray(value) for name, value in result.setup.outputs.items()}
    else:
        clip = np.minimum(frames(), 225) if machines else frames()  # so that an offset still fits
        sent = {name: np.asarray(value) for name, value in chip.run(clip).outputs.items()}
    wanted = ORACLES[exercise.name](clip)
    assert sent.keys() == wanted.keys()
    for name, values in wanted.items():
        assert np.array_equal(sent[name], values), name


def frames() -> Clip:
    clips = [np.load(bundled("clip")[name].path)[FRAMES] for name in CLIPS]
    grey = np.arange(96, 104, dtype=np.uint8)[:, None, None] * np.ones((1, 64, 80), np.uint8)
    return np.concatenate([*clips, grey, 255 - clips[0][:2]])


def test_an_exercise_needs_only_what_came_before() -> None:
    """Each instruction of a solution was shown on its page or an earlier one."""
    known: set[str] = set()
    instructions = set(load_isa().instructions)
    for exercise in EXERCISES:
        known |= set(re.findall(r"[A-Z]{2,}", exercise.page)) & instructions
        used = {*_SHOWN.findall(exercise.shown_solution())} & instructions
        assert not used - known, exercise.name


@each_exercise
def test_names_of_registers_on_a_page_are_declared(exercise: Exercise) -> None:
    """Lines of a page can be copied below its starter: no name of a register is missing."""
    shown = "\n".join(_SNIPPET.findall(exercise.page))
    starter = (exercise.folder / "starter.s").read_text()
    declared = "\n".join(line for line in shown.splitlines() if line.startswith(".reg "))
    known = [*re.findall(r"^\.reg (\w+)", f"{starter}\n{declared}", re.MULTILINE)]
    for line in shown.splitlines():
        found = _REGISTER.match(line)
        if found and not re.fullmatch(r"r\d+", found["name"]):
            assert found["name"] in known or found["name"] in _EXAMPLE, line


@each_exercise
def test_hidden_checks_look_at_other_frames(exercise: Exercise) -> None:
    """Of what the hidden runs see, something is not in the shown ones."""
    shown, hidden = (
        {(run.frames, run.first, run.levels) for run in checked_suite(path).runs}
        for path in (exercise.checks, exercise.solution)
    )
    assert hidden - shown or exercise.name == "board"


@each_exercise
def test_hidden_checks_stay_hidden(exercise: Exercise) -> None:
    handed = b"".join(exercise.handed_out().values())
    hidden = [line for line in exercise.solution.read_bytes().splitlines() if b"golden" in line]
    assert hidden
    assert b"golden" not in handed
    assert b"<!--" not in exercise.handed_out()["page.md"]
    assert "golden" not in exercise.shown_solution()
    assert "expect:" not in exercise.shown_solution()


@pytest.mark.long
@each_exercise
def test_the_picture_is_what_its_command_draws(
    exercise: Exercise, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = _COMMAND.search(exercise.page)
    assert command is not None
    shutil.copytree(exercise.folder, tmp_path / "copy")
    monkeypatch.chdir(tmp_path / "copy")
    Path("picture.png").unlink()
    done = CliRunner().invoke(cli, command[1].split(), prog_name="npchip")
    assert done.exit_code == 0, done.output
    drawn, kept = (
        np.asarray(Image.open(folder / "picture.png").convert("L"), int)
        for folder in (Path(), exercise.folder)
    )
    assert drawn.shape == kept.shape
    assert (np.abs(drawn - kept) > 8).mean() < 0.005  # letters may be drawn otherwise
