"""The runs of a sweep, in a stable order, each with the hash of all that decides its result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import prod

from npchip.base.errors import InputError
from npchip.sweep import content
from npchip.sweep.axes import MOST, Value
from npchip.sweep.model import Chip, Clip, Definition, DrawnClip, ProgramFile

FIXED = ("run", "status", "error", "frames", "cycles_mean", "cycles_max", "words", "instructions")
"""Columns that every table of programs has."""


@dataclass(frozen=True, slots=True)
class Run:
    """One run: a row of the table.

    Attributes:
        key: hash of all that decides the result.
        axes: the row's values along the axes.
        program: the program; None for an experiment.
        program_key: hash of the program.
        clip: the clip, if there is one.
        clip_key: hash of the clip.
        chip: the machine; None for an experiment without machines.
        define: values of constants, or arguments of the experiment.
    """

    key: str
    axes: tuple[tuple[str, Value | None], ...]
    program: ProgramFile | None
    program_key: str
    clip: Clip | None
    clip_key: str
    chip: Chip | None
    define: tuple[tuple[str, Value], ...]


def expand(definition: Definition) -> list[Run]:
    """Return the runs: programs, clips, machines and definitions, the last one varies fastest.

    Raises:
        InputError: NP645 too many runs, NP646 rows that could not be told apart, NP641 a file
            that cannot be read, NP647 no such experiment.
    """
    _check(definition)
    runs: dict[tuple[tuple[str, Value | None], ...], Run] = {}
    for run in _runs(definition):
        if runs.setdefault(run.axes, run).key != run.key:
            same = ", ".join(f"{name} {value}" for name, value in run.axes if value is not None)
            raise InputError(
                "NP646",
                f"{definition.file}: two runs have the same row: {same}",
                hint="give a machine that is written out a 'name' of its own",
            )
    return list(runs.values())


def _check(definition: Definition) -> None:
    lists = (definition.programs or (None,), definition.clips, definition.machines or (None,))
    count = prod(map(len, (*lists, *definition.define.values())))
    if count > MOST:
        raise InputError(
            "NP645",
            f"{definition.file}: {count:,} runs, expected at most {MOST:,}",
            hint="leave out values of an axis, or divide the sweep",
        )
    taken = {*FIXED, "program", "clip", "machine", "seed"}
    if definition.experiment:
        taken = {"run", "status", "error", "machine"}
    for chip in definition.machines:
        taken |= chip.axes.keys()
    for name in definition.define:
        if name in taken:
            raise InputError(
                "NP646",
                f"{definition.file}: the table has another column {name}",
                hint="give the constant another name",
            )


def _runs(definition: Definition) -> Iterator[Run]:
    programs: list[tuple[ProgramFile | None, str]] = [
        (item, content.of_program(item.path)) for item in definition.programs
    ]
    if definition.experiment:
        programs = [(None, content.of_experiment(definition.experiment))]
    clips = [(item, content.of_clip(item)) for item in definition.clips]
    chips: list[tuple[Chip | None, str]] = [
        (item, content.of_machine(item.machine)) for item in definition.machines
    ]
    settings = [
        tuple(zip(definition.define, chosen, strict=True))
        for chosen in product(*definition.define.values())
    ]
    columns = dict.fromkeys(name for chip in definition.machines for name in chip.axes)
    seeds = any(isinstance(clip, DrawnClip) for clip, _ in clips)
    common = [content.version(), definition.first, definition.fit]
    for (program, program_key), (clip, clip_key), (chip, chip_key) in product(
        programs, clips, chips or [(None, "")]
    ):
        for define in settings:
            key = content.digest([*common, program_key, clip_key, chip_key, sorted(define)])
            axes: dict[str, Value | None] = {}
            if program:
                axes |= {"program": program.label, "clip": clip.label if clip else None}
            if chip:
                axes["machine"] = chip.label
            axes |= dict(define)
            axes |= {name: chip.axes[name] for name in columns if chip}
            if seeds:
                axes["seed"] = clip.seed if clip else None
            yield Run(key, tuple(axes.items()), program, program_key, clip, clip_key, chip, define)
