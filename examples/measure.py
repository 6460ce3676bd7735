"""Runs of the programs of asm/ from which pages of docs/ take their figures.

For the scripts that write pages; nothing of it is needed to use npchip.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from npchip import Chip, assemble, load_machine
from npchip.frames import open_frames
from npchip.isa import load_isa
from npchip.partner import sent_by
from npchip.report.comparison import Column
from npchip.tasks import cycles_by_task

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from npchip import Program

ROOT = Path(__file__).parents[1]
FOLDERS = tuple(ROOT / "examples" / name for name in ("clips", "orientation", "templates"))
MACHINES = ("default", "conservative")


@dataclass(frozen=True)
class Setting:
    """What a program is run on.

    Attributes:
        clip: a file of `FOLDERS`.
        defines: constants that differ from their defaults.
        memory: files of `FOLDERS` by the address that they are written to.
        partner: program and clip of the other camera, for a program that has one.
    """

    clip: str = "coin_slide"
    defines: Mapping[str, int] = field(default_factory=dict)
    memory: Mapping[int, str] = field(default_factory=dict)
    partner: tuple[str, str] | None = None


SHAPES = Setting("shapes_photo", {"THRESHOLD": 190})
SETTINGS = {
    "imaging": Setting(),
    "frame_difference": Setting(),
    "edges": Setting(),
    "smooth": Setting(),
    "median": Setting(),
    "dct": Setting(),
    "statistics": Setting(),
    "tracking": Setting(),
    "trajectory": Setting(),
    "trajectory_mixed": Setting(),
    "trajectory_nonlinear": Setting(),
    "trajectory_robust": Setting(),
    "keypoints": SHAPES,
    "keypoints_farthest": SHAPES,
    "recognise": SHAPES,
    "orientation": Setting("frames-64x80", memory={208: "weights-64x80"}),
    "correlate": Setting(memory={128: "disc"}),
    "sighting": Setting("ball.2"),
    "fusion_lut": Setting("ball.1", memory={192: "fusion_chip"}, partner=("sighting", "ball.2")),
}
"""Every program of asm/, in the order of the pages."""


@dataclass(frozen=True)
class Run:
    """A program that has run.

    Attributes:
        program: what ran.
        column: its cycles, by frame and by task.
        executions: int64, shape (words,): how often each word was executed.
    """

    program: Program
    column: Column
    executions: NDArray[np.int64]


@cache
def clip(name: str) -> NDArray[np.uint8]:
    """Frames of a bundled clip, uint8, shape (T, 64, 80), or bytes of a memory file."""
    for folder in FOLDERS:
        if (folder / f"{name}.npy").is_file():
            frames: NDArray[np.uint8] = np.load(folder / f"{name}.npy")
            return frames
    return np.stack(list(open_frames(ROOT / "examples" / "rigs" / f"{name}.gif", 64, 80)))


def load_templates(chip: Chip, setting: Setting) -> None:
    """Write the memory of a setting."""
    for address, file in setting.memory.items():
        chip.load_memory(address, clip(file))


@cache
def run(name: str, machine_name: str = "default") -> Run:
    """Run a program of asm/ on the frames of its setting."""
    setting, machine = SETTINGS[name], load_machine(machine_name)
    program = assemble(ROOT / "asm" / f"{name}.s", machine, setting.defines)
    chip = Chip(program, machine)
    load_templates(chip, setting)
    if setting.partner:
        other = assemble(ROOT / "asm" / f"{setting.partner[0]}.s", machine)
        sent = Chip(other, machine).run(clip(setting.partner[1]))
        chip.connect(sent_by(other, sent, machine.geometry))
    result = chip.run(clip(setting.clip))
    assert result.status == "frames-exhausted", result.error
    tasks = cycles_by_task(program, machine, load_isa(), chip.executions)
    column = Column(name, f"asm/{name}.s", machine, len(program.words), result, tasks)
    return Run(program, column, chip.executions)


def table(head: Sequence[str], rows: Sequence[Sequence[str]], numbers: int = 0) -> str:
    """Return a Markdown table; its last `numbers` columns are aligned on the right."""
    rule = ["---"] * (len(head) - numbers) + ["--:"] * numbers
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, rule, *rows])


def write_page(name: str, document: Callable[[], str]) -> None:
    """Write a page of docs/, or the file that the command line names."""
    page = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / name
    page.write_text(document(), encoding="utf-8")
