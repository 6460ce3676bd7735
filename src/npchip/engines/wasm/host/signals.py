"""Defers signal handlers while a module runs, until their exceptions can propagate.

Python would run a handler at the beginning of wasmtime's own callback. An exception there is lost,
and the module goes on with a result that was never written. So a stand-in notes the signal, and
the handler is called from the host's method. While the host calls a feed, a sink or a partner,
handlers are called at once.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, Final

_NUMBERS: Final = tuple(map(int, signal.valid_signals()))
_Handler = Callable[[int, FrameType | None], Any]


class Signals:
    """Defers the handlers that are installed when a module begins to run."""

    def __init__(self) -> None:
        self._handlers: dict[int, _Handler] = {}
        self._noted: list[int] = []
        self._inside = False  # whether the module or a method of its host runs

    @contextmanager
    def deferred(self) -> Iterator[None]:
        """Defer handlers until `deliver` is called or the context ends."""
        if threading.current_thread() is not threading.main_thread():
            yield  # only the main thread has handlers
            return
        handlers = {number: signal.getsignal(number) for number in _NUMBERS}
        self._handlers = {n: handler for n, handler in handlers.items() if callable(handler)}
        try:
            for number in self._handlers:
                signal.signal(number, self._stand_in)
            self._inside = True
            yield
        finally:
            self._inside = False
            for number, handler in self._handlers.items():
                if signal.getsignal(number) == self._stand_in:
                    signal.signal(number, handler)
            self._call()

    @contextmanager
    def immediate(self) -> Iterator[None]:
        """Within `deferred`, call handlers at once: the code inside may take long."""
        if not self._inside:  # another thread
            yield
            return
        try:
            self._inside = False
            self._call()
            yield
        finally:
            self._inside = True
            self._defer_again()

    def deliver(self) -> None:
        """Within `deferred`, call the handlers of the signals so far. Their exceptions pass."""
        if self._noted:
            with self.immediate():
                pass

    def _defer_again(self) -> None:
        """Defer again the handlers that have been replaced meanwhile."""
        for number in tuple(self._handlers):
            handler = signal.getsignal(number)
            if handler == self._stand_in:
                continue
            del self._handlers[number]
            if callable(handler):
                self._handlers[number] = handler
                signal.signal(number, self._stand_in)

    def _call(self) -> None:
        while self._noted:
            number = self._noted.pop(0)
            self._handlers[number](number, None)

    def _stand_in(self, number: int, frame: FrameType | None) -> None:
        if self._inside:
            self._noted.append(number)
        else:
            self._handlers[number](number, frame)
