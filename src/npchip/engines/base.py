"""What every engine offers, and what it needs: frames in, frame records out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from npchip.engines.batch import FrameBatch
from npchip.engines.state import ChipState, Write


class Feed(Protocol):
    """Where exposed frames come from."""

    def planes(self, index: int) -> NDArray[np.uint8] | None:
        """Frame number `index` since reset as planes, (64, R, C); None where the input ends."""

    def frames(self, index: int, most: int) -> NDArray[np.uint8]:
        """Frames from number `index` since reset on: contiguous, shape (n, rows, columns).

        n is from 1 to `most`, and 0 where the input ends. The frames of the last two calls
        can be asked for again.
        """


@dataclass(frozen=True)
class Request:
    """What an input instruction asks its partner for.

    Attributes:
        port: port number.
        frame: frames exposed since reset, less one: -1 before the first.
        index: inputs from this port in this frame before it.
        cycle: cycles of this frame before it.
    """

    port: int
    frame: int
    index: int
    cycle: int


Partner = Callable[[Request], NDArray[np.uint8] | None]
"""What the partner camera sent: uint8, shape (NP rows, NP columns); None where it sent nothing.

It gives the same each time that the same is asked: a run may go back to repeat what it did.
"""

Hear = Callable[[Request], NDArray[np.uint8] | None]
"""A partner that is asked in the right way, if there is one."""


class Sink(Protocol):
    """Where complete frames go. The first one of a run is its setup."""

    @property
    def taken(self) -> int:
        """Frames taken so far."""

    def take(self, batch: FrameBatch) -> None:
        """Take complete frames, the last one before its successor is exposed.

        What it raises ends the run after the last frame that was taken.
        """


class Fault(Exception):  # noqa: N818 - the base of errors
    """Something that ends a run, and the instruction to blame.

    Attributes:
        code: stable identifier such as ``"NP301"``.
        address: of the instruction.
        processor: (row, column) of the NP to blame, if there is one.
    """

    def __init__(
        self, code: str, message: str, address: int, processor: tuple[int, int] | None = None
    ) -> None:
        super().__init__(message)
        self.code = code
        self.address = address
        self.processor = processor


class TrapError(Fault):
    """The chip cannot go on; the state is that before the instruction at `address`.

    But for instructions of one's own that write something before they open or close a masked
    region, or do something else that fails: what they have written stays. The code is one of
    NP301 to NP309.
    """


Stop = Literal["halted", "frames-exhausted", "cycle-limit"]


class Engine(Protocol):
    """Executes a program on a `ChipState`. Engines neither print, open files nor read clocks.

    Attributes:
        name: of the engine that executes.
        notice: why it is another one than was asked for; empty if it is not.
        state: of the chip.
    """

    name: str
    notice: str
    state: ChipState
    partner: Partner | None

    def run(self, feed: Feed, limit: int, sink: Sink) -> Stop:
        """Execute until the program halts, the frames end or a frame reaches the cycle limit.

        Args:
            feed: gives the frames.
            limit: cycles of one frame, tested before each instruction.
            sink: takes the frames that are complete.

        Raises:
            TrapError: an instruction cannot be executed.
        """

    def step(
        self, feed: Feed, on_frame: Callable[[FrameBatch], None], written: list[Write] | None = None
    ) -> Stop | None:
        """Execute one instruction; None while the program can go on. Raises as `run`.

        Args:
            feed: gives the frames.
            on_frame: called with a frame that the instruction completes, as a batch of one.
            written: takes what the instruction writes, in its order.
        """

    def refresh(self) -> None:
        """Follow a state that was changed from outside."""
