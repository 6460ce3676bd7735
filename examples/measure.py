"""Runs and sweeps from which pages of docs/ take their figures.

Sweeps are those of examples/sweeps; the environment variable NPCHIP_SWEEPS may name a folder that
keeps their tables, so that only what is missing is computed again.

For the scripts that write pages; nothing of it is needed to use npchip.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from examples.target import asked
from npchip.isa import load_isa
from npchip.profile.tasks import cycles_by_task
from npchip.report.comparison import Column
from npchip.testing.cases import Case, cases_of
from npchip.testing.runner import Settings, execute
from npchip.testing.suite import read_suite

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from npchip import Program

ROOT = Path(__file__).parents[1]
CLIPS = ROOT / "examples" / "clips"
MACHINES = ("default", "conservative")


ORDER = (
    "imaging",
    "frame_difference",
    "edges",
    "smooth",
    "median",
    "dct",
    "statistics",
    "tracking",
    "tracking_large",
    "trajectory",
    "trajectory_large",
    "trajectory_mixed",
    "trajectory_nonlinear",
    "trajectory_robust",
    "trajectory_mixed_large",
    "trajectory_nonlinear_large",
    "trajectory_robust_large",
    "follow",
    "follow_large",
    "follow_many",
    "follow_many_large",
    "keypoints",
    "keypoints_farthest",
    "recognise",
    "polygons",
    "orientation",
    "digits",
    "correlate",
    "sighting",
    "fusion_lut",
)
"""Programs in the order of the pages; others follow by name."""

PROGRAMS = tuple(
    sorted(
        (path.stem for path in (ROOT / "asm").glob("*.s")),
        key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name),
    )
)
"""Every program of asm/."""

RUNS = {
    "keypoints": "photo",
    "keypoints_farthest": "drawn",
    "recognise": "photo",
    "polygons": "photo",
    "orientation": "chip",
    "digits": "digits",
}
"""The test run that a program is measured on, unless that is ``coin``."""


@dataclass(frozen=True)
class Run:
    """A program that has run.

    Attributes:
        program: what ran.
        clip: what it ran on.
        column: its cycles, by frame and by task.
        executions: int64, shape (words,): how often each word was executed.
    """

    program: Program
    clip: str
    column: Column
    executions: NDArray[np.int64]


@cache
def clip(name: str) -> NDArray[np.uint8]:
    """Frames of a bundled clip: uint8, shape (T, 64, 80)."""
    frames: NDArray[np.uint8] = np.load(CLIPS / f"{name}.npy")
    return frames


def case_of(source: Path, machine: str) -> Case:
    """The test run of a source that it is measured by: the first one that both machines have."""
    cases = {case.name: case for case in cases_of(read_suite(source))}
    wanted = RUNS.get(source.stem, "coin")
    both = [name for name in cases if f"{name}@conservative" in cases]
    name = wanted if wanted in both else both[0]
    return cases[name if machine == "default" else f"{name}@{machine}"]


@cache
def run(name: str, machine: str = "default") -> Run:
    """Run a program of asm/ as its own test lines say."""
    case = case_of(ROOT / "asm" / f"{name}.s", machine)
    chip, result = execute(case, Settings())
    assert result.status == "frames-exhausted", result.error
    tasks = cycles_by_task(chip.program, chip.machine, load_isa(), chip.executions)
    words = len(chip.program.words)
    column = Column(name, f"asm/{name}.s", chip.machine, words, result, tasks)
    return Run(chip.program, Path(case.run.frames or "levels").stem, column, chip.executions)


def swept(name: str, **values: str | float) -> pd.DataFrame:
    """Return the rows of a sweep of examples/sweeps that have these values in their columns."""
    found = _swept(name)
    for column, value in values.items():
        found = found[found[column] == value]
    return found


@cache
def _swept(name: str) -> pd.DataFrame:
    from npchip.sweep import load  # noqa: PLC0415 - with an extra

    sweep = load(ROOT / "examples" / "sweeps" / f"{name}.yaml")
    with TemporaryDirectory() as temporary:
        folder = Path(os.environ.get("NPCHIP_SWEEPS", temporary)) / name
        found = sweep.run(folder=folder)
    failed = found[found["error"].notna()]
    assert failed.empty, failed["error"].iloc[0]
    return found


def spread(values: Iterable[float], digits: int) -> str:
    """Return mean and standard deviation as text."""
    each = np.array(list(values), float)
    return f"{each.mean():.{digits}f} ± {each.std(ddof=1):.{digits}f}"


def table(head: Sequence[str], rows: Sequence[Sequence[str]], numbers: int = 0) -> str:
    """Return a Markdown table; its last `numbers` columns are aligned on the right."""
    rule = ["---"] * (len(head) - numbers) + ["--:"] * numbers
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, rule, *rows])


def write_page(name: str, document: Callable[[], str]) -> None:
    """Write a page of docs/, or the file that the command line names."""
    page = asked(ROOT / "docs" / name)
    page.write_text(document(), encoding="utf-8")
