"""Signals while a module runs: their handlers wait until what they raise can be passed on.

A signal's handler runs where Python goes on next. While a module runs that is the beginning of
wasmtime's own callback, where an exception is lost and the module goes on with a result that was
never written. So another handler stands in their place, which only takes a note there, and they
are called in the host's method. Where that calls others' Python, for frames, results or a partner,
they are called at once.
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
    """Signals of one module: those that have a handler when it begins to run."""

    def __init__(self) -> None:
        self._handlers: dict[int, _Handler] = {}
        self._noted: list[int] = []
        self._inside = False  # the module, or its host's own methods

    @contextmanager
    def deferred(self) -> Iterator[None]:
        """Let handlers wait for `deliver`, or for the end."""
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
        """Within `deferred`: call handlers at once, as others' code may take its time."""
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
        """Within `deferred`: call the handlers of signals that have come; raises what they do."""
        if self._noted:
            with self.immediate():
                pass

    def _defer_again(self) -> None:
        """Others' code, or a handler, may have exchanged handlers."""
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
