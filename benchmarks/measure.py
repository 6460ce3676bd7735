"""Medians of processor time, whole processes by the clock, and how far a measurement is."""

from __future__ import annotations

import gc
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial

REPEATS = 5
_SHORT = 0.02


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
    """Return `processor_time` of several works, in turn, so that all see the same machine."""
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


def pace(run: Callable[[int], object], most: int) -> float:
    """Return about how many frames a second are run, to plan measurements by.

    Args:
        run: runs a number of frames.
        most: largest number to run.
    """
    count = min(50, most)
    while True:
        seconds = processor_time(partial(run, count), 1)
        if seconds > _SHORT or count == most:
            return count / seconds
        count = min(most, 4 * count)


def plan(pace: float, most: int, seconds: float) -> tuple[int, int]:
    """Return frames of a run, and how many runs take about so many seconds.

    Args:
        pace: frames a second.
        most: largest number of frames of a run.
        seconds: what all runs together may take.
    """
    frames = max(1, min(most, round(pace * seconds)))
    return frames, max(1, round(pace * seconds / frames))


@contextmanager
def progress(steps: int) -> Iterator[Callable[[str], None]]:
    """Give what shows a step on a terminal; where there is none it does nothing."""
    terminal, done = sys.stderr.isatty(), 0

    def tick(text: str) -> None:
        nonlocal done
        if terminal:
            print(f"\r\x1b[K{100 * done // steps:3} %  {text}", end="", file=sys.stderr, flush=True)
        done += 1

    try:
        yield tick
    finally:
        if terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
