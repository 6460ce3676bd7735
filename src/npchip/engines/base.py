"""What every engine offers, and what it needs: frames in, frame records out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from npchip.engines.state import ChipState, RawFrame


class Feed(Protocol):
    """Where exposed frames come from."""

    def planes(self, index: int) -> NDArray[np.uint8] | None:
        """Frame number `index` since reset as planes, (64, R, C); None where the input ends."""


class TrapError(Exception):
    """The chip cannot go on; the state is that before the instruction at `address`.

    Attributes:
        code: NP301 to NP309.
        processor: (row, column) of the NP to blame, if there is one.
    """

    def __init__(
        self, code: str, message: str, address: int, processor: tuple[int, int] | None = None
    ) -> None:
        super().__init__(message)
        self.code = code
        self.address = address
        self.processor = processor


Stop = Literal["halted", "frames-exhausted", "cycle-limit"]


class Engine(Protocol):
    """Executes a program on a `ChipState`. Engines neither print, open files nor read clocks."""

    name: str
    state: ChipState

    def run(self, feed: Feed, limit: int, on_frame: Callable[[RawFrame], None]) -> Stop:
        """Execute until the program halts, the frames end or a frame reaches the cycle limit.

        Args:
            feed: gives the frames.
            limit: cycles of one frame, tested before each instruction.
            on_frame: called when a frame (or the setup) is complete, before its successor is
                exposed; what it raises ends the run.

        Raises:
            TrapError: an instruction cannot be executed.
        """

    def step(self, feed: Feed, on_frame: Callable[[RawFrame], None]) -> Stop | None:
        """Execute one instruction; None while the program can go on. Raises as `run`."""
