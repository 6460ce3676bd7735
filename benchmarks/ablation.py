"""The worth of each part of the compiled engine: programs with and without it, in turn.

A part stays if it gives `MEAN` over all programs or `ONE` on one of them, in steady speed or in the
time from source to first frame.
"""

from __future__ import annotations

import statistics
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, Final
from unittest import mock

import numpy as np
import wasmtime

from benchmarks.measure import interleaved, pace, plan, processor_time
from benchmarks.parts import Part
from benchmarks.programs import long_clip, made, sources
from npchip import Chip, assemble

SECONDS: Final = 0.01
"""About what one measurement of frames per second takes: other programs slow down both alike."""
MEAN: Final = 0.03
ONE: Final = 0.10
CONTROL: Final = "unchanged"
"""The row of a second engine with all its parts: how far from 1 the figures are by chance."""

_DEEP: Final = 100_000
"""Python's recursion limit meanwhile, as long chains of values are not cut where a part is off."""
_CHECKED: Final = 40
"""Frames on which the results without a part are compared with those of the whole engine."""

Table = dict[str, dict[str, Any]]


@dataclass
class Times:
    """Times of a program without a part, one for each round, divided by those of the engine."""

    steady: list[float] = field(default_factory=list)
    ready: list[float] = field(default_factory=list)


Without = Callable[[], AbstractContextManager[object]]
"""Gives a time in which the engine translates without a part."""


def ablation(parts: Sequence[Part], rounds: int, tick: Callable[[str], None]) -> Table:
    """Measure the programs of ``asm/`` without each of some parts.

    Args:
        parts: the parts.
        rounds: how often each program is measured without each part.
        tick: called with the name of each program before it is measured.

    Raises:
        AssertionError: the results of a program differ without a part.
    """
    clip, times = long_clip(), {name: dict[str, Times]() for name in (CONTROL, *names(parts))}
    with _deep():
        for program, source in sources().items():
            tick(program)
            for name, found in _measured(source, clip, parts, rounds).items():
                times[name][program] = found
    lines = {part.name: part.lines for part in parts}
    return {name: {"lines": lines.get(name, 0), **row(found)} for name, found in times.items()}


def names(parts: Sequence[Part]) -> list[str]:
    """Return the names of parts."""
    return [part.name for part in parts]


def row(programs: Mapping[str, Times]) -> dict[str, Any]:
    """Return speed and time to be ready without a part, of all programs and of the worst one."""
    speed = {name: 1 / statistics.median(found.steady) for name, found in programs.items()}
    ready = {name: statistics.median(found.ready) for name, found in programs.items()}
    slowest, latest = min(speed, key=speed.__getitem__), max(ready, key=ready.__getitem__)
    means = statistics.geometric_mean(speed.values()), statistics.geometric_mean(ready.values())
    return {
        "speed": means[0],
        "worst speed": speed[slowest],
        "slowest": slowest,
        "ready": means[1],
        "worst ready": ready[latest],
        "latest": latest,
        "stays": min(means[0], 1 / means[1]) <= 1 - MEAN
        or min(speed[slowest], 1 / ready[latest]) <= 1 - ONE,
    }


def shown(table: Table) -> str:
    """Return the table as text."""
    head = ("without", "lines", "speed", "worst", "", "ready", "worst", "", "by the rule")
    lines = [_LINE.format(*head)]
    for name, cells in table.items():
        verdict = "stays" if cells["stays"] else "goes"
        if name == CONTROL:
            verdict = "too noisy to judge" if cells["stays"] else "-"
        speed = (f"{cells[key]:.2f}" for key in ("speed", "worst speed"))
        ready = (f"{cells[key]:.2f}" for key in ("ready", "worst ready"))
        count = cells["lines"] or "-"
        figures = (*speed, cells["slowest"], *ready, cells["latest"])
        lines.append(_LINE.format(name, count, *figures, verdict))
    return "\n".join([*lines, _MEANING])


_LINE: Final = "{:<26}{:>5} {:>6} {:>6} {:<21}{:>6} {:>6} {:<21}{}"
_MEANING: Final = f"""\
Speed in steady state (below 1: slower without the part), and time from source to first frame
(above 1: longer without it), as parts of the whole engine's: geometric mean and worst program.
A part stays if it gives {MEAN:.0%} in a mean or {ONE:.0%} on a program."""


def _measured(source: Path, clip: Any, parts: Sequence[Part], rounds: int) -> dict[str, Times]:
    """Measure a program in turn: the whole engine, again, and without each part."""
    expected, modules = _results(source, nullcontext, clip)
    variants: dict[str, Without] = {CONTROL: nullcontext}
    same = set()  # steady speed cannot differ
    for part in parts:
        variants[part.name] = part.without
        results, others = _results(source, part.without, clip)
        if results != expected:
            raise AssertionError(f"{source.stem} has other results without {part.name}")
        if others == modules:
            same.add(part.name)
    chip = made(assemble(source), engine="wasm")
    chip.run(clip[:1])
    work = plan(pace(partial(_run, chip, clip), len(clip)), len(clip), SECONDS)
    times = {name: Times() for name in variants}
    for index in range(rounds):
        for place, (name, without) in enumerate(variants.items()):
            pair: list[Without] = [nullcontext, without]
            order = (0, 1) if (index + place) % 2 else (1, 0)  # who goes first changes
            # Fresh chips, as one of them may happen to lie well in memory.
            found = [
                {which: _ready(source, pair[which], clip) for which in order} for _ in range(3)
            ]
            seconds = [statistics.median(one[which][0] for one in found) for which in (0, 1)]
            times[name].ready.append(seconds[1] / seconds[0])
            if name in same:
                times[name].steady.append(1)
                continue
            works = {str(which): partial(_run, found[-1][which][1], clip, *work) for which in order}
            for warm in works.values():
                warm()
            steady = interleaved(works)
            times[name].steady.append(steady["1"] / steady["0"])
    return times


def _ready(source: Path, without: Without, clip: Any) -> tuple[float, Chip]:
    """Return seconds from the source to the result of the first frame, and the chip."""
    chips: list[Chip] = []

    def first() -> None:
        chips.append(made(assemble(source), engine="wasm"))
        chips[0].run(clip[:1])

    with without():
        seconds = processor_time(first, 1)
    return seconds, chips[0]


def _run(chip: Chip, clip: Any, frames: int, passes: int = 1) -> None:
    for _ in range(passes):
        chip.reset()
        chip.run(clip[:frames])


def _results(source: Path, without: Without, clip: Any) -> tuple[dict[str, Any], list[Any]]:
    """Return outputs and cycles of a short run, and what wasmtime has compiled for it."""
    chip = made(assemble(source), engine="wasm")
    with without(), mock.patch.object(wasmtime, "Module", wraps=wasmtime.Module) as compiled:
        found = chip.run(clip[:_CHECKED])
    modules = [call.args for call in compiled.call_args_list]
    assert modules
    outputs = {
        name: values.tolist() if isinstance(values, np.ndarray) else values
        for name, values in found.outputs.items()
    }
    return {**outputs, "cycles": chip.cycles}, modules


@contextmanager
def _deep() -> Iterator[None]:
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(_DEEP)
    try:
        yield
    finally:
        sys.setrecursionlimit(before)
