"""Medians of processor time, and whole processes by the clock."""

from __future__ import annotations

import gc
import statistics
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence

REPEATS = 5


def processor_time(
    work: Callable[[], object],
    repeats: int = REPEATS,
    clock: Callable[[], float] = time.process_time,
) -> float:
    """Median processor time of one call in seconds, or the time of another clock.

    Another program's load does not count, nor does what earlier calls have left behind: garbage is
    collected before, and as usual meanwhile.
    """
    times = []
    for _ in range(repeats):
        gc.collect()
        start = clock()
        work()
        times.append(clock() - start)
    return statistics.median(times)


def interleaved(
    works: Mapping[str, Callable[[], object]],
    repeats: int = REPEATS,
    clock: Callable[[], float] = time.process_time,
) -> dict[str, float]:
    """As `processor_time` for several, in turn, so that all see the same machine."""
    times: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(repeats):
        for name, work in works.items():
            times[name].append(processor_time(work, 1, clock))
    return {name: statistics.median(values) for name, values in times.items()}


def processes(commands: dict[str, Sequence[str]], repeats: int = REPEATS) -> dict[str, float]:
    """Median time of whole processes in seconds, by the clock, in turn."""
    times: dict[str, list[float]] = {name: [] for name in commands}
    for _ in range(repeats):
        for name, command in commands.items():
            start = time.perf_counter()
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            times[name].append(time.perf_counter() - start)
    return {name: statistics.median(values) for name, values in times.items()}
