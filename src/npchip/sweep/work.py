"""Work of a process: it runs a batch, and keeps compiled programs and clips for the next one."""

from __future__ import annotations

import gc
import importlib
import math
import sys
import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError, NpchipError
from npchip.frames import Fit, FrameSource, frames_from_iterable, open_frames
from npchip.host.scenes.render import render
from npchip.machine import Machine
from npchip.program.model import Program
from npchip.run.chip import Chip
from npchip.sweep.content import of_experiment, version
from npchip.sweep.measure import Columns, Truth, columns_of, row_of, truth_of
from npchip.sweep.model import Clip, ClipFile, Experiment

_T = TypeVar("_T")

_MOST_CHIPS: Final = 8
_MOST_CLIPS: Final = 64
_MOST_PIXELS: Final = 1 << 28
"""Pixels of the clips that a worker keeps; a longer clip is read anew for every run."""


@dataclass(frozen=True)
class Footage:
    """A clip as it is sent to a worker: its frames, and where the object is."""

    frames: NDArray[np.uint8] | FrameSource
    truth: Truth | None


@dataclass(frozen=True)
class Task:
    """One run of a batch: its hash, its clip and the clip's hash, arguments of an experiment."""

    key: str
    clip: Clip | None = None
    clip_key: str = ""
    arguments: Mapping[str, Any] | None = None


@dataclass(frozen=True)
class Batch:
    """Runs that share a program and a machine.

    Attributes:
        tasks: the runs.
        program: the program, or the error that assembling it has met.
        machine: the machine.
        first: frames of each clip; None for all.
        fit: what to do with frames of another size.
        frames: whether the columns of each frame are wanted.
        experiment: what is called instead.
        version: npchip's version.
    """

    tasks: Sequence[Task]
    program: Program | NpchipError | None
    machine: Machine | None
    first: int | None
    fit: Fit | None
    frames: bool
    experiment: Experiment | None
    version: str


@dataclass(frozen=True)
class Done:
    """A run that has been made.

    Attributes:
        key: the run's hash.
        row: its columns but for the axes.
        frames: the columns of each frame, if they are wanted.
        again: True if the run may end differently next time: a file could not be read.
    """

    key: str
    row: dict[str, Any]
    frames: Columns | None = None
    again: bool = False


class OtherVersionError(Exception):
    """A worker has another version of npchip."""


class _Kept(threading.local):
    """Compiled programs and clips of a thread, the last used ones."""

    def __init__(self) -> None:
        self.chips: OrderedDict[tuple[Program, Machine], Chip] = OrderedDict()
        self.clips: OrderedDict[tuple[Any, ...], Footage] = OrderedDict()
        self.made = 0  # chips
        self.modules: dict[str, str] = {}  # the hash of each module of experiments


_kept = _Kept()


def forget() -> None:
    """Drop what this thread keeps."""
    _kept.chips.clear()
    _kept.clips.clear()


def do(batch: Batch, footage: Sequence[Footage | InputError | None] | None = None) -> list[Done]:
    """Return the results of a batch.

    Args:
        batch: the runs.
        footage: their clips, where the worker has no files of its own, or why there are none.

    Raises:
        OtherVersionError: this worker has another version of npchip.
    """
    if batch.version != version():
        raise OtherVersionError(version())
    if batch.experiment:
        function = _function(batch.experiment)
        return [_experiment(function, task) for task in batch.tasks]
    if isinstance(batch.program, NpchipError):
        return [_failed(task.key, batch.program) for task in batch.tasks]
    given = footage or [None] * len(batch.tasks)
    return [_run(batch, task, clip) for task, clip in zip(batch.tasks, given, strict=True)]


def _failed(key: str, error: BaseException, *, again: bool = False) -> Done:
    text = str(error) if isinstance(error, NpchipError) else f"{type(error).__name__}: {error}"
    return Done(key, {"status": "failed", "error": text}, again=again)


_OWN: Final = frozenset({"run", "status", "error"})
"""Columns of every table, which no experiment can write."""


def _experiment(function: Callable[..., Mapping[str, Any]], task: Task) -> Done:
    try:
        found = function(**(task.arguments or {}))
        row = {_name(name): _number(value) for name, value in found.items()}
    except Exception as error:  # noqa: BLE001 - what a user's function raises is its result
        return _failed(task.key, error)
    return Done(task.key, {"status": "done", "error": None, **row})


def _name(name: str) -> str:
    if name in _OWN:
        raise ValueError(f"a result is named {name!r}, which is a column of every sweep")
    return name


def _number(value: Any) -> Any:
    plain = value.item() if hasattr(value, "item") else value
    if plain is not None and not isinstance(plain, int | float | str):
        raise TypeError(f"expected numbers, found {type(value).__name__}")
    if isinstance(plain, float) and math.isinf(plain):
        raise ValueError("expected finite numbers, found an infinite one")
    return None if isinstance(plain, float) and math.isnan(plain) else plain


def _function(experiment: Experiment) -> Callable[..., Mapping[str, Any]]:
    """Import the function of an experiment.

    Raises:
        InputError: NP647 there is none.
    """
    folder = str(experiment.folder)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    before, now = _kept.modules.get(experiment.module), of_experiment(experiment)
    _kept.modules[experiment.module] = now
    try:
        module = importlib.import_module(experiment.module)
        if before not in {None, now}:
            module = importlib.reload(module)
        found = getattr(module, experiment.function)
    except (ImportError, AttributeError) as error:
        raise InputError("NP647", f"experiment: {error}") from None
    return found  # type: ignore[no-any-return]


def _run(batch: Batch, task: Task, given: Footage | InputError | None) -> Done:
    program, machine = batch.program, batch.machine
    assert isinstance(program, Program)
    assert machine is not None
    try:
        if isinstance(given, InputError):
            raise given
        footage = given
        if footage is None and task.clip is not None:
            footage = kept_footage(task.clip, task.clip_key, machine, batch.first, batch.fit)
        chip = _last_used(
            _kept.chips,
            (program, machine),  # not the names: a file may have changed since
            lambda: _made(program, machine),
            _MOST_CHIPS,
        )
        chip.reset()
        result = chip.run(None if footage is None else footage.frames)
    except InputError as error:  # a clip that is gone, or a frame in its middle
        return _failed(task.key, error, again=True)
    except MemoryError as error:
        return _failed(task.key, error, again=True)
    row = row_of(result, program, footage.truth if footage else None)
    return Done(task.key, row, columns_of(result) if batch.frames else None)


def _made(program: Program, machine: Machine) -> Chip:
    """Make a chip. Those that gave way before hold each other, and megabytes, until collected."""
    _kept.made += 1
    if _kept.made % _MOST_CHIPS == 0:
        gc.collect()
    return Chip(program, machine)


def kept_footage(
    clip: Clip, key: str, machine: Machine, first: int | None, fit: Fit | None
) -> Footage:
    """Return a clip that was read before, or read it.

    Raises:
        InputError: it cannot be read.
    """
    whole = (key, machine.rows, machine.cols, first, fit)
    made = _last_used(
        _kept.clips, whole, lambda: read_footage(clip, machine, first, fit), _MOST_CLIPS
    )
    sizes = [
        item.frames.size for item in _kept.clips.values() if isinstance(item.frames, np.ndarray)
    ]
    while sum(sizes) > _MOST_PIXELS and len(sizes) > 1:
        _, dropped = _kept.clips.popitem(last=False)
        if isinstance(dropped.frames, np.ndarray):
            sizes.remove(dropped.frames.size)
    return made


def read_footage(clip: Clip, machine: Machine, first: int | None, fit: Fit | None) -> Footage:
    """Read or draw a clip; a long one stays in its file.

    Raises:
        InputError: it cannot be read.
    """
    if not isinstance(clip, ClipFile):
        frames, truth = render(replace(clip.scene, seed=clip.seed))
        return Footage(frames[:first], Truth(truth.centers[:first, 0], truth.visible[:first, 0]))
    source = open_frames(clip.path, machine.rows, machine.cols, fit)
    most = min(first or _MOST_PIXELS, _MOST_PIXELS // (machine.rows * machine.cols) + 1)
    most = min(most, source.count or most)
    batch, failure = source.read(iter(source), most)
    if failure is not None:
        raise failure
    held: NDArray[np.uint8] | FrameSource = batch.copy()
    if len(batch) == most not in {first, source.count}:
        held = source if first is None else _only(source, first, machine)
    return Footage(held, truth_of(clip.path, first))


def _only(source: FrameSource, first: int, machine: Machine) -> FrameSource:
    return frames_from_iterable(_First(source, first), machine.rows, machine.cols)


class _First:
    """The first frames of a source, as often as they are asked for."""

    def __init__(self, source: FrameSource, count: int) -> None:
        self._source, self._count = source, count

    def __iter__(self) -> Any:
        return islice(iter(self._source), self._count)


def _last_used(kept: OrderedDict[Any, _T], key: Any, make: Callable[[], _T], most: int) -> _T:
    """Return what is kept under a key, or make it; the one used longest ago gives way."""
    if key not in kept:
        kept[key] = make()
        if len(kept) > most:
            kept.popitem(last=False)
    kept.move_to_end(key)
    return kept[key]
