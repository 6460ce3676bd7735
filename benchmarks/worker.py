"""Measure the npchip that is on the path, as lines of the standard input ask for it.

``python -m benchmarks --against`` keeps one such process for each of the two trees. A line is
``pace PROGRAM``, ``steady PROGRAM FRAMES PASSES`` or ``ready PROGRAM``; each is answered by a line
with a number. The first line that is written tells which npchip is measured.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Final

import npchip
from benchmarks.measure import pace, processor_time
from benchmarks.programs import FRAMES, long_clip, made, sources
from npchip import Chip, assemble

_READY_TIMES: Final = 3


class Bench:
    """The programs of a tree, each on a chip that stays.

    Args:
        tree: folder with the ``asm/`` that belongs to the package on the path.
    """

    def __init__(self, tree: Path) -> None:
        self._sources = sources(tree)
        self._clip = long_clip()
        self._chip = cache(self._warm)

    def pace(self, name: str) -> float:
        """Return about how many frames a second are run, to plan measurements by."""
        return pace(partial(self._run, self._chip(name)), FRAMES)

    def steady(self, name: str, frames: str, passes: str) -> float:
        """Return frames per second of a chip that has been running before."""
        chip = self._chip(name)

        def work() -> None:
            for _ in range(int(passes)):
                self._run(chip, int(frames))

        seconds = processor_time(work, 1)
        return int(passes) * chip.frames_taken / seconds

    def ready(self, name: str) -> float:
        """Return seconds from the source to the result of a fresh chip's first frame."""

        def work() -> None:
            made(assemble(self._sources[name])).run(self._clip[:1])

        return processor_time(work, _READY_TIMES)

    def _run(self, chip: Chip, frames: int) -> None:
        chip.reset()
        chip.run(self._clip[:frames])

    def _warm(self, name: str) -> Chip:
        chip = made(assemble(self._sources[name]))
        chip.run(self._clip[:2])
        return chip


def main() -> None:
    """Answer until the input ends."""
    bench = Bench(Path(sys.argv[1]))
    actions: dict[str, Callable[..., float]] = {
        "pace": bench.pace,
        "steady": bench.steady,
        "ready": bench.ready,
    }
    print(npchip.__file__, flush=True)
    for line in sys.stdin:
        action, *arguments = line.split()
        print(actions[action](*arguments), flush=True)


if __name__ == "__main__":
    main()
