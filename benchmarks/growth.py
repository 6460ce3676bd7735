"""The cost of more frames and larger arrays."""

from __future__ import annotations

import resource
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.measure import processor_time
from benchmarks.programs import ROOT
from npchip import Chip, assemble, load_machine

GROWN_FRAMES = 1_000

Table = dict[str, dict[str, float]]


def growth(clip: Any) -> Table:
    """Over frames (streamed from an iterator, with peak memory) and over the array's size."""
    table: Table = {}
    chip = Chip(assemble(ROOT / "asm" / "trajectory.s"), engine="wasm")
    chip.run(clip[:2])
    for count in (100, 1_000, 10_000, 100_000, 1_000_000):
        chip.reset()
        stream = (clip[index % len(clip)] for index in range(count))
        seconds = processor_time(lambda s=stream: chip.run(s), 1)  # type: ignore[misc]
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        table[f"{count:,} frames"] = {"us per frame": 1e6 * seconds / count, "peak MB": peak}
    for shape in ((8, 10), (16, 16), (16, 20), (32, 32)):
        machine = replace(load_machine("default"), name="grown", np_rows=shape[0], np_cols=shape[1])
        program = assemble(ROOT / "asm" / "trajectory.s", machine)
        frames = np.resize(clip, (GROWN_FRAMES, machine.rows, machine.cols))
        large = Chip(program, machine, engine="wasm")
        large.run(frames[:2])

        def work(chip: Chip = large, frames: Any = frames) -> None:
            chip.reset()
            chip.run(frames)

        seconds = processor_time(work)
        nps = shape[0] * shape[1]
        table[f"{shape[0]} x {shape[1]} NPs"] = {
            "us per frame": 1e6 * seconds / len(frames),
            "ns per frame and NP": 1e9 * seconds / len(frames) / nps,
        }
    return table
