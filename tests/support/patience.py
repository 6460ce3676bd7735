"""An end for what takes too long."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final, Literal

CLOCKS: Final = {
    "clock": (signal.ITIMER_REAL, signal.SIGALRM),
    "processor": (signal.ITIMER_PROF, signal.SIGPROF),
}


@contextmanager
def at_most(
    seconds: float, error: BaseException, by: Literal["clock", "processor"]
) -> Iterator[None]:
    """Raise an error in what takes longer, by the clock or by processor time; main thread only."""

    def stop(*_: object) -> None:
        raise error

    timer, number = CLOCKS[by]
    before = signal.signal(number, stop)
    signal.setitimer(timer, seconds)
    try:
        yield
    finally:
        signal.setitimer(timer, 0)
        signal.signal(number, before)
