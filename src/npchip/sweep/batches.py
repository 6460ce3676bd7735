"""Runs in batches: one program, one machine, some clips, and work for every worker."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import groupby
from math import ceil
from pathlib import Path
from typing import Any, Final, cast

from npchip.base.errors import InputError, NpchipError
from npchip.formats import load_program
from npchip.frames.memory import with_bytes
from npchip.machine import Machine
from npchip.program.model import Program
from npchip.sweep.content import version
from npchip.sweep.model import Definition
from npchip.sweep.plan import Run
from npchip.sweep.work import Batch, Task

_MOST: Final = 32
"""Runs of a batch: so many clips stay in a worker while all programs pass by."""
_FEW: Final = 8
"""Calls of an experiment in a batch: each may take seconds, and what is at work can be lost."""
_EACH: Final = 8
"""Batches that each worker should have, so that all end at about the same time."""
_SENSELESS: Final = {"NP025", "NP026", "NP113", "NP115"}
"""Errors of a program that the sweep file is to blame for: no source, no such constant."""


def check(runs: Sequence[Run]) -> None:
    """Assemble each program once, before anything runs.

    Raises:
        InputError: the file cannot be read, or the program has no such constant.
    """
    for run in {run.program: run for run in runs}.values():
        found = _program(run)
        if isinstance(found, InputError) and found.code in _SENSELESS:
            raise found


def batches(definition: Definition, runs: Sequence[Run], workers: int) -> Iterator[Batch]:
    """Yield the batches of runs, none of them twice.

    Args:
        definition: the sweep.
        runs: the runs that are missing.
        workers: number of workers.
    """
    missing = list({run.key: run for run in runs}.values())
    most = max(1, min(_MOST, ceil(len(missing) / (_EACH * max(1, workers)))))
    if definition.experiment:
        few = min(most, _FEW)
        for start in range(0, len(missing), few):
            yield _batch(definition, missing[start : start + few], None)
        return
    numbers = {key: number for number, key in enumerate(dict.fromkeys(_clip(r) for r in missing))}
    clips = [numbers[_clip(run)] // _MOST for run in missing]
    order = sorted(zip(clips, map(_variant, missing), range(len(missing)), strict=True), key=_first)
    for _, group in groupby(order, key=_first):
        same = [missing[index] for *_, index in group]
        program = _program(same[0])
        for start in range(0, len(same), most):
            yield _batch(definition, same[start : start + most], program)


def _first(item: tuple[int, str, int]) -> tuple[int, str]:
    return item[0], item[1]


def _clip(run: Run) -> str:
    return run.clip_key


def _variant(run: Run) -> str:
    """Return what tells apart programs, constants and machines."""
    assert run.program is not None
    assert run.chip is not None
    return repr((str(run.program.path), run.define, run.chip.label, run.chip.axes))


def _batch(
    definition: Definition, runs: Sequence[Run], program: Program | NpchipError | None
) -> Batch:
    first = runs[0]
    machine = first.chip.machine if first.chip else None
    return Batch(
        tasks=[_task(run) for run in runs],
        program=program,
        machine=machine,
        first=definition.first,
        fit=definition.fit,
        frames=definition.frames,
        experiment=definition.experiment,
        version=version(),
    )


def _task(run: Run) -> Task:
    if run.program is not None:
        return Task(run.key, run.clip, run.clip_key)
    arguments: dict[str, Any] = dict(run.define)
    if run.chip is not None:
        arguments["machine"] = run.chip.machine
    return Task(run.key, arguments=arguments)


def _program(run: Run) -> Program | NpchipError:
    """Return the program of a run, or the error that assembling it meets."""
    assert run.program is not None
    assert run.chip is not None
    define = cast("tuple[tuple[str, int], ...]", run.define)
    return _assembled(run.program.path, run.program_key, run.chip.machine, define)


@lru_cache(maxsize=4)
def _assembled(
    path: Path, _key: str, machine: Machine, define: tuple[tuple[str, int], ...]
) -> Program | NpchipError:
    """Assemble a program, whose hash is `_key`; workers need no file of its ``.memory`` lines."""
    try:
        return with_bytes(load_program(path, machine, dict(define)), machine)
    except NpchipError as error:
        return error
