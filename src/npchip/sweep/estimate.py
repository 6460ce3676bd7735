"""Estimate the time of a sweep from one short run of every program."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import islice
from typing import Final

from npchip.sweep.batches import batches
from npchip.sweep.model import ClipFile, Definition
from npchip.sweep.plan import Run
from npchip.sweep.work import do

_FRAMES: Final = 64
"""Frames of a trial run."""
_LONG: Final = 1000
"""Frames that a clip is taken to have where its length is not known."""


def seconds(definition: Definition, missing: Sequence[Run], workers: int) -> float:
    """Return about how long the missing runs will take.

    Each program is assembled, compiled and run on the first frames of its first clip; every other
    variant is taken to need as long, and every other clip as long for a frame.
    """
    total = 0.0
    for program in dict.fromkeys(run.program for run in missing):
        runs = [run for run in missing if run.program == program]
        variants = len(
            {
                (run.define, run.chip and run.chip.label, str(run.chip and run.chip.axes))
                for run in runs
            }
        )
        if definition.experiment:
            total += _timed(definition, runs[:1]) * len(runs)
            continue
        short = replace(definition, first=1)
        start = _timed(short, runs[:1])
        again = _timed(short, runs[:1])  # compiled, and the clip is read
        trial = replace(definition, first=_FRAMES)
        _timed(trial, runs[:1])  # reads or draws the clip, which is not done again for each run
        longer = _timed(trial, runs[:1])
        frame = max(0.0, longer - again) / _FRAMES
        total += (start - again) * variants + sum(
            again + frame * _frames(definition, r) for r in runs
        )
    return total / max(1, workers)


def _timed(definition: Definition, runs: Sequence[Run]) -> float:
    begin = time.perf_counter()
    for batch in islice(batches(definition, runs, 1), 1):
        do(batch)
    return time.perf_counter() - begin


def _frames(definition: Definition, run: Run) -> int:
    if run.clip is None:
        return 0
    if isinstance(run.clip, ClipFile):
        return definition.first or _LONG
    return min(definition.first or run.clip.scene.frames, run.clip.scene.frames)
