"""Going back from the end of a long run, against the time that the run itself takes."""

from __future__ import annotations

import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import REPEATS, processor_time
from npchip import Chip, assemble
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One, Pixel

FRAMES = 10_000
ROOT = Path(__file__).parents[1]


def debugger(clip: Any) -> dict[str, dict[str, float]]:
    """Seconds of processor time in a session at frame 10,000 of ``trajectory.s``."""
    program = assemble(ROOT / "asm" / "trajectory.s")
    frames = np.resize(clip, (FRAMES, *clip.shape[1:]))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    session = Debugger(program, frames)
    table: dict[str, dict[str, float]] = {}
    chip = Chip(program)
    table["plain run, 10,000 frames"] = {"s": processor_time(lambda: chip.run(frames), 1)}
    table["run in the debugger"] = {"s": processor_time(session.run, 1)}
    assert session.chip.frames_taken == FRAMES
    end = session.time
    register = One(Cell("register", 13), 3, 4)
    works: dict[str, Callable[[], object]] = {
        "step back": session.step_back,
        "back a frame": session.previous_frame,
        "who wrote a register": lambda: session.who(register),
        "who wrote a pixel": lambda: session.who(Pixel(20, 33)),
        "to the middle of the run": lambda: session.seek(end // 2),
        "run back to a label": session.run_back,
    }
    session.add("predict")
    for name, work in works.items():
        times = []
        for _ in range(REPEATS):
            session.seek(end)
            times.append(processor_time(work, 1))
        table[name] = {"s": max(times), "median s": sorted(times)[REPEATS // 2]}
    count, size = session.snapshots
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    table["snapshots"] = {"count": count, "MB": size / 2**20}
    table["memory of the session"] = {"MB": (after - before) / 1024}
    return table
