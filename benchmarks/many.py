"""Several clips at once, beside one after the other."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import interleaved
from npchip import Chip, Program, RunResult, assemble

ROOT = Path(__file__).parents[1]
CASES = (
    ("trajectory", 16, 50_000),
    ("imaging", 16, 5_000),
    ("trajectory", 200, 100),
    ("trajectory", 16, 1),
)
"""Program, number of clips, frames of each."""


def many(clip: Any) -> dict[str, dict[str, float]]:
    """Seconds by the clock from the program to all results; a fresh chip each time."""
    table: dict[str, dict[str, float]] = {}
    for name, count, frames in CASES:
        program = assemble(ROOT / "asm" / f"{name}.s")
        clips = [np.resize(clip, (frames, *clip.shape[1:])) for _ in range(count)]
        works: dict[str, Callable[[], object]] = {
            "at once": lambda p=program, c=clips: Chip(p).run_many(c),  # type: ignore[misc]
            "one chip, in turn": lambda p=program, c=clips: _in_turn(p, c),  # type: ignore[misc]
            # Not last: after a fork the next work would copy the pages that it writes.
            "two processes": partial(_apart, Chip(program), clips),
            "a chip each, in turn": lambda p=program, c=clips: [Chip(p).run(o) for o in c],  # type: ignore[misc]
        }
        times = interleaved(works, clock=time.perf_counter)
        ours = times["at once"]
        row = {f"{work}, ms": 1000 * seconds for work, seconds in times.items()}
        row |= {f"{work}, times": times[work] / ours for work in list(works)[1:]}
        table[f"{name}, {count} x {frames:,} frames"] = row
    return table


def _in_turn(program: Program, clips: Sequence[Any]) -> list[RunResult]:
    return _each(Chip(program), clips)


def _each(chip: Chip, clips: Sequence[Any]) -> list[RunResult]:
    results = []
    for clip in clips:
        chip.reset()
        results.append(chip.run(clip))
    return results


def _apart(chip: Chip, clips: Sequence[Any]) -> None:
    """Run every other clip in a process that shares nothing: what two cores can give.

    Args:
        chip: compiled before, in all rounds but the first.
        clips: frames of each clip.
    """
    child = os.fork()
    if not child:
        try:
            _each(chip, clips[1::2])
        finally:
            os._exit(0)
    _each(chip, clips[::2])
    os.waitpid(child, 0)
