"""A worker thread, which keeps the screen responsive."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, Generic, TypeVar

if TYPE_CHECKING:
    from textual.app import App

_MOST: Final = 32
_Result = TypeVar("_Result")


class Worker(Generic[_Result]):
    """Runs tasks in a thread, one after the other.

    Args:
        app: the application.
        done: called with each result in the application's thread.

    Attributes:
        busy: True while a task runs or waits.
        under_way: True while a task runs.
    """

    def __init__(self, app: App[Any], done: Callable[[_Result], None]) -> None:
        self.busy = False
        self.under_way = False
        self._app = app
        self._done = done
        self._pending: deque[Callable[[], _Result]] = deque(maxlen=_MOST)

    def do(self, work: Callable[[], _Result]) -> None:
        """Queue a task. The oldest one is dropped if the queue is full."""
        self._pending.append(work)
        if not self.busy:
            self.busy = True
            self._app.run_worker(self._work, thread=True)

    def forget(self) -> None:
        """Drop the tasks in the queue."""
        self._pending.clear()

    def _work(self) -> None:
        while True:
            try:
                work = self._pending.popleft()
            except IndexError:
                break
            self.under_way = True
            try:
                result = work()
            finally:
                self.under_way = False
            if not self._app.is_running:
                return
            self._app.call_from_thread(self._done, result)
        self._app.call_from_thread(self._idle)

    def _idle(self) -> None:
        if self._pending:  # queued just now
            self._app.run_worker(self._work, thread=True)
        else:
            self.busy = False
