"""Running to the start of a trace, at the full speed of the engine."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, islice
from typing import TYPE_CHECKING, Any

import numpy as np

from npchip.base.errors import InputError
from npchip.run.stuck import stuck

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.frames import FrameSource
    from npchip.run.chip import Chip

_BLOCK = 64
_POSITION = re.compile(r"(f?)(\d[\d_]{0,17})", re.ASCII)


@dataclass(frozen=True)
class Position:
    """A moment of a run.

    Attributes:
        number: number of a frame since reset, 0-based, or cycles since reset.
        is_frame: True for the expose that takes that frame; False for the first instruction that
            begins at that cycle or later.
    """

    number: int
    is_frame: bool

    @classmethod
    def parse(cls, text: str) -> Position:
        """Read a cycle such as ``1200`` or a frame such as ``f12``.

        Raises:
            InputError: NP610, the text is neither.
        """
        match = _POSITION.fullmatch(text.strip())
        if match is None:
            raise InputError(
                "NP610",
                f"expected a cycle such as 1200 or a frame such as f12, found '{text[:40]}'",
            )
        return cls(int(match[2]), bool(match[1]))

    def reached(self, cycle: int, frame: int | None) -> bool:
        """Return whether an instruction that begins at `cycle` in `frame` is at or after this."""
        if self.is_frame:
            return frame is not None and frame >= self.number
        return cycle >= self.number


def seek(chip: Chip, frames: FrameSource | None, position: Position, limit: int) -> None:
    """Run a chip to a position and feed it the rest of the frames.

    If the program ends earlier, the chip stops in its last frame.

    Args:
        chip: a chip after reset.
        frames: the clip.
        position: the position.
        limit: cycle limit of a frame, as for `Chip.run`.

    Raises:
        InputError: NP611, a frame before the position reaches the limit.
        TrapError: the program fails on the way.
    """
    rest: Iterator[NDArray[np.uint8]] = iter(()) if frames is None else iter(frames)
    before = chip.snapshot()
    if position.is_frame and not _run(chip, [], position, limit):  # the part before frame 0
        chip.restore(before)
    for size in (_BLOCK, 1):
        while True:
            wanted = position.number - chip.frames_taken if position.is_frame else size
            block = list(islice(rest, min(size, wanted)))
            before = chip.snapshot()
            if not block or not _run(chip, block, position, limit):
                chip.restore(before)
                rest = chain(block, rest)
                break
    chip.feed(rest)
    while not position.is_frame and chip.cycles < position.number:
        if chip.step():
            break


def _run(chip: Chip, block: list[Any], position: Position, limit: int) -> bool:
    """Run some frames; return False if the program ended or the position was passed."""
    result = chip.run(np.stack(block) if block else iter(()), max_cycles=limit)
    if result.status == "cycle-limit" and (position.is_frame or chip.cycles < position.number):
        at = stuck(chip)
        raise InputError(
            "NP611",
            f"frame {chip.frames_taken - 1} takes more than {limit:,} cycles ({at.place}{at.loops})"
            ": the trace would begin behind it",
            hint="let it begin earlier with --from",
        )
    if result.status != "frames-exhausted":
        return False
    return position.is_frame or chip.cycles <= position.number
