"""The interface of engines: frames in, records of complete frames out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

from npchip.base.frozen import PortableError

if TYPE_CHECKING:  # a module is made where there is no NumPy
    import numpy as np
    from numpy.typing import NDArray

    from npchip.engines.batch import FrameBatch
    from npchip.engines.state import ChipState, Write


class Feed(Protocol):
    """Provides the frames to expose. They are numbered from 0 since reset."""

    def planes(self, index: int) -> NDArray[np.uint8] | None:
        """Return a frame as planes, uint8, shape (64, R, C), or None if the input has ended."""

    def frames(self, index: int, most: int) -> NDArray[np.uint8]:
        """Return frames from number `index` on: uint8, contiguous, shape (n, rows, columns).

        n is from 1 to `most`, or 0 if the input has ended. The frames of the last two calls must
        remain available.
        """


@dataclass(frozen=True)
class Request:
    """A request by an input instruction for a plane from the partner camera.

    Attributes:
        port: port number.
        frame: number of the exposed frame since reset; -1 before the first.
        index: number of earlier inputs from this port in this frame.
        cycle: cycles of this frame before the instruction.
    """

    port: int
    frame: int
    index: int
    cycle: int


Partner = Callable[[Request], "NDArray[np.uint8] | None"]
"""Returns what the partner camera sent: uint8, shape (NP rows, NP columns), or None for nothing.

Equal requests must get equal answers, as an engine may repeat a part of a run.
"""


class Sink(Protocol):
    """Takes complete frames. The first one of a run is its setup."""

    @property
    def taken(self) -> int:
        """Number of frames taken so far."""

    def take(self, batch: FrameBatch) -> None:
        """Take complete frames before the next frame is exposed.

        An exception ends the run after the last frame that was taken.
        """


class Fault(PortableError):  # noqa: N818 - the base of errors
    """An error that ends a run, with the instruction at fault.

    Attributes:
        code: stable identifier such as ``"NP301"``.
        address: address of the instruction.
        processor: (row, column) of the NP at fault; None if it is not a single NP.
    """

    def __init__(
        self, code: str, message: str, address: int, processor: tuple[int, int] | None = None
    ) -> None:
        super().__init__(message)
        self.code = code
        self.address = address
        self.processor = processor


class TrapError(Fault):
    """The chip cannot execute the instruction at `address`; the state is that before it.

    Only a custom instruction may fail after its first writes, and these remain. The code is one of
    NP301 to NP309.
    """


Stop = Literal["halted", "frames-exhausted", "cycle-limit"]


class Engine(Protocol):
    """Executes a program on a `ChipState`. Engines do not print, open files or read clocks.

    Attributes:
        name: name of the engine that executes.
        notice: why it is not the requested engine; empty if it is.
        state: state of the chip.
        partner: answers input instructions; None without a partner camera.
    """

    name: str
    notice: str
    state: ChipState
    partner: Partner | None

    def run(self, feed: Feed, limit: int, sink: Sink) -> Stop:
        """Execute until the program halts, the frames end or a frame reaches the cycle limit.

        Args:
            feed: provides the frames.
            limit: cycle limit of one frame, checked before each instruction.
            sink: takes the complete frames.

        Raises:
            TrapError: an instruction cannot be executed.
        """

    def step(
        self, feed: Feed, on_frame: Callable[[FrameBatch], None], written: list[Write] | None = None
    ) -> Stop | None:
        """Execute one instruction. Return None while the program can continue.

        Args:
            feed: provides the frames.
            on_frame: called with a frame that the instruction completes, as a batch of one.
            written: list to which the instruction's writes are appended, in order.

        Raises:
            TrapError: the instruction cannot be executed.
        """

    def refresh(self) -> None:
        """Adapt to a state that was changed from outside."""

    def another(self) -> Engine | None:
        """Return an engine in the reset state that runs the same program in another thread.

        None if the two would only wait for each other.
        """
