"""Parts of a sweep: programs, clips, machines and the values of its axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from npchip.frames import Fit
from npchip.host.scenes.model import Scene
from npchip.machine import Machine
from npchip.sweep.axes import Value


@dataclass(frozen=True)
class ProgramFile:
    """A program: its name in the table, and its file."""

    label: str
    path: Path


@dataclass(frozen=True)
class ClipFile:
    """A clip in a file or a folder."""

    label: str
    path: Path

    seed: int | None = None  # a file has none


@dataclass(frozen=True)
class DrawnClip:
    """A clip that is drawn where it is needed."""

    label: str
    scene: Scene
    seed: int


Clip = ClipFile | DrawnClip


@dataclass(frozen=True)
class Chip:
    """A machine: its name in the table, and its values along the axes of the machines."""

    label: str
    machine: Machine
    axes: Mapping[str, Value] = field(default_factory=dict)


@dataclass(frozen=True)
class Experiment:
    """A function of a module that is called instead of running a program.

    Attributes:
        module: name of the module.
        function: name of the function: from the values of the axes to a mapping of numbers.
        folder: folder of the sweep file, in which the module may lie.
    """

    module: str
    function: str
    folder: Path


@dataclass(frozen=True)
class Definition:
    """All that a sweep file says.

    Attributes:
        file: the file, as messages name it.
        name: the file's name without its ending.
        programs: the programs; none for an experiment.
        clips: the clips; None alone for programs that take no frames.
        machines: the machines.
        define: values of each constant, or of each axis of an experiment.
        first: number of frames of each clip; None for all.
        frames: whether each frame is wanted.
        fit: what to do with frames of another size.
        experiment: what is called instead of programs.
    """

    file: str
    name: str
    programs: tuple[ProgramFile, ...] = ()
    clips: tuple[Clip | None, ...] = (None,)
    machines: tuple[Chip, ...] = ()
    define: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    first: int | None = None
    frames: bool = False
    fit: Fit | None = None
    experiment: Experiment | None = None
