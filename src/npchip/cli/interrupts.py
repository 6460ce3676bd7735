"""A Ctrl-C that always takes effect.

Python may raise ``KeyboardInterrupt`` anywhere. In a finalizer or the callback of a weak reference
Python only reports it and continues. While a class is made, another exception wraps it.
"""

from __future__ import annotations

import _thread
import signal
import sys
import threading
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

_SOON: Final = 0.01
"""Seconds until a lost interrupt is repeated."""


def keep_interrupts() -> None:
    """Repeat a ``KeyboardInterrupt`` that was lost, instead of reporting it."""
    report = sys.unraisablehook

    def again(lost: UnraisableHookArgs) -> None:
        if issubclass(lost.exc_type, KeyboardInterrupt):
            timer = threading.Timer(_SOON, _interrupt)
            timer.daemon = True
            timer.start()
        else:
            report(lost)

    sys.unraisablehook = again


def _interrupt() -> None:
    if sys.platform == "win32":
        _thread.interrupt_main()
    else:  # a signal also wakes a sleeping main thread
        main = threading.main_thread().ident
        assert main is not None
        signal.pthread_kill(main, signal.SIGINT)


def is_interrupt(error: BaseException | None) -> bool:
    """Return whether an exception is a ``KeyboardInterrupt`` or was caused by one."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None
