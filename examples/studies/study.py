"""Studies of another chip: programs rewritten for one more instruction, or for a larger ROM.

A study takes lines out of a program and puts others in their place, runs both on the program's own
test run, and holds that they send the same. ``docs/networks.md`` shows what is measured. What an
instruction costs is a decision of its machine file, not a statement on the silicon.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from examples.measure import ROOT, case_of
from npchip import RunResult
from npchip.isa import load_isa, read_isa
from npchip.testing.runner import Settings, execute

FOLDER = ROOT / "examples" / "studies"


class Edit(NamedTuple):
    """Lines of a source that others take the place of.

    Attributes:
        file: the source, below the working copy.
        first: the first of the lines; it occurs once.
        last: the last of them, the next line like this.
        lines: what stands there instead.
    """

    file: str
    first: str
    last: str
    lines: str

    def apply(self, root: Path) -> None:
        """Change the file below a folder.

        Raises:
            ValueError: the lines are not there, or more than once.
        """
        path = root / self.file
        text = path.read_text(encoding="utf-8")
        before, *behind = text.split(f"\n{self.first}")
        if len(behind) != 1:
            raise ValueError(f"{self.file}: {len(behind)} lines begin with '{self.first}'")
        _, found, after = f"{self.first}{behind[0]}".partition(self.last)
        if not found:
            raise ValueError(f"{self.file}: no '{self.last}' behind '{self.first}'")
        path.write_text(f"{before}\n{self.lines}{after}", encoding="utf-8")


@dataclass(frozen=True)
class Study:
    """A program on another chip.

    Attributes:
        program: its source, below the working copy.
        edits: what is changed in it and in what it includes.
        isa: file of the instruction set, in examples/studies; "" for the built-in one.
        machines: machines to measure on, by name or file in examples/studies.
    """

    program: str
    edits: tuple[Edit, ...] = ()
    isa: str = ""
    machines: tuple[str, str] = ("default", "conservative")


class Cost(NamedTuple):
    """Cost of a program on a machine.

    Attributes:
        words: its words.
        mean: cycles of a mean frame.
        result: its run.
    """

    words: int
    mean: float
    result: RunResult


@cache
def cost(program: str, machine: str = "default") -> Cost:
    """Measure a program as it is on its test run."""
    return _measured(Study(program), machine)


@cache
def changed(study: Study, machine: str) -> Cost:
    """Measure the program of a study.

    Raises:
        AssertionError: it does not send what the program sends.
    """
    found, before = _measured(study, machine), cost(study.program)
    assert same_outputs(found.result, before.result), f"{study.program} sends something else"
    return found


def same_outputs(a: RunResult, b: RunResult) -> bool:
    """Return whether two runs have sent the same."""
    return a.frames == b.frames and all(
        np.array_equal(np.array(a.value(name, k)), np.array(b.value(name, k)))
        for name in a.outputs
        for k in range(a.frames)
    )


def _measured(study: Study, name: str) -> Cost:
    isa = read_isa(FOLDER / study.isa) if study.isa else load_isa()
    with TemporaryDirectory() as temporary:
        root = Path(temporary)
        copytree(ROOT / "asm", root / "asm")
        (root / "examples").mkdir()
        for each in (ROOT / "examples").iterdir():
            if each != FOLDER:
                (root / "examples" / each.name).symlink_to(each)
        copytree(FOLDER, root / "examples" / "studies")
        for edit in study.edits:
            edit.apply(root)
        machine = str(FOLDER / name) if name.endswith(".yaml") else name
        case = replace(case_of(root / study.program, "default"), machine=machine)
        chip, result = execute(case, Settings(isa=isa, include_paths=(root / "asm",)))
    assert result.status == "frames-exhausted", result.error
    return Cost(len(chip.program.words), float(result.frame_cycles.mean()), result)
