"""Time and memory of a sweep of 2,000 runs: one process, two, a plain loop, a second call.

    python -m benchmarks.sweeps [ROUNDS]

Start-up is included everywhere. The ways take turns, so that what else the machine does meets all
of them; medians are shown, with the range. Writes its tables into a temporary folder.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import NamedTuple

from npchip.sweep import load

SWEEP = Path(__file__).parents[1] / "examples" / "sweeps" / "thresholds.yaml"

PLAIN = """
import sys
from npchip import Chip, assemble
from npchip.host.scenes.render import render
from npchip.sweep import load
from dataclasses import replace
sweep = load(sys.argv[1]).definition
clips = [render(replace(clip.scene, seed=clip.seed))[0] for clip in sweep.clips]
for program in sweep.programs:
    for chip in sweep.machines:
        for threshold in sweep.define["THRESHOLD"]:
            defines = {"THRESHOLD": threshold}
            made = Chip(assemble(program.path, chip.machine, defines=defines), chip.machine)
            for clip in clips:
                made.reset()
                made.run(clip)
"""
"""The loop that a sweep takes the place of: it keeps nothing and writes nothing."""


class Taken(NamedTuple):
    """Cost of a process: seconds by the clock and of processors, and its peak memory in MB."""

    seconds: float
    processor: float
    memory: float


def taken(*arguments: str) -> Taken:
    """Run Python with some arguments and measure it, with the processes that it starts."""
    begin = time.perf_counter()
    process = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{arguments}: exit {process.returncode}")
    seconds = time.perf_counter() - begin
    return Taken(seconds, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def main() -> None:
    """Measure and print."""
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    found: dict[str, list[Taken]] = {}
    with TemporaryDirectory() as temporary:
        for number in range(rounds):
            ways: dict[str, Sequence[str]] = {"plain loop": ("-c", PLAIN, str(SWEEP))}
            for jobs in ("0", "2"):
                where = f"{temporary}/{jobs}-{number}"
                call = ("-m", "npchip", "sweep", str(SWEEP), "--jobs", jobs, "-o", where)
                ways[f"--jobs {jobs}"] = call
                ways[f"--jobs {jobs}, again"] = call
            for way, arguments in ways.items():
                found.setdefault(way, []).append(taken(*arguments))
                print(way, number, found[way][-1], os.getloadavg(), flush=True)
            first, second = (Path(f"{temporary}/{jobs}-{number}") for jobs in "02")
            for name in ("runs.csv", "runs.parquet", "sweep.json"):
                assert (first / name).read_bytes() == (second / name).read_bytes(), name
    for way, each in found.items():
        seconds = [item.seconds for item in each]
        print(
            f"{way:18} {median(seconds):7.1f} s ({min(seconds):.1f} to {max(seconds):.1f}),"
            f" processor {median(item.processor for item in each):.1f} s,"
            f" memory {max(item.memory for item in each):.0f} MB"
        )
    runs = len(load(SWEEP).runs)
    one, two, plain = (found[way] for way in ("--jobs 0", "--jobs 2", "plain loop"))
    gain = median(a.seconds / b.seconds for a, b in zip(one, two, strict=True))
    more = median(a.processor - b.processor for a, b in zip(one, plain, strict=True))
    print(f"two processes are {gain:.2f} times as fast as one")
    print(f"overhead of a run, processor time: {1000 * more / runs:.2f} ms of {runs} runs")


if __name__ == "__main__":
    main()
