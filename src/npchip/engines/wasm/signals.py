"""Signals while a module runs: their handlers wait until what they raise can be passed on.

A signal's handler runs where Python goes on next. While a module runs that is the beginning of
wasmtime's own callback, where an exception is lost and the module goes on with a result that was
never written. So handlers only take a note there, and what they do is done in the host's method.
Where that calls somebody else's Python, for frames, results or a partner, they are in their place.
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
    """Signals of one module."""

    def __init__(self) -> None:
        self._handlers: dict[int, _Handler] = {}
        self._noted: list[tuple[_Handler, int]] = []

    @contextmanager
    def deferred(self) -> Iterator[None]:
        """Let handlers wait for `deliver`, or for the end."""
        if threading.current_thread() is not threading.main_thread():
            yield  # only the main thread has handlers
            return
        handlers = {number: signal.getsignal(number) for number in _NUMBERS}
        self._handlers = {n: handler for n, handler in handlers.items() if callable(handler)}
        try:
            self._wait()
            yield
        finally:
            self._go_on()
            self._handlers = {}
            self.deliver()

    @contextmanager
    def in_place(self) -> Iterator[None]:
        """Within `deferred`: let handlers run at once, as others' code may take its time."""
        try:
            self._go_on()
            self.deliver()
            yield
        finally:
            self._wait()

    def _wait(self) -> None:
        raised: BaseException | None = None
        for number in self._handlers:
            try:
                before = signal.signal(number, self._note)
            except BaseException as error:  # noqa: BLE001 - of a handler whose signal had just come
                before, raised = signal.signal(number, self._note), error
            if callable(before):  # others' code may have set another one
                self._handlers[number] = before
        if raised is not None:
            raise raised

    def _go_on(self) -> None:
        for number, handler in self._handlers.items():
            signal.signal(number, handler)

    def _note(self, number: int, _frame: FrameType | None) -> None:
        self._noted.append((self._handlers[number], number))

    def deliver(self) -> None:
        """Call the handlers of the signals that have come; raises what they raise."""
        while self._noted:
            handler, number = self._noted.pop(0)
            handler(number, None)
