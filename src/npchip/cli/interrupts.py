"""Ctrl-C that is not lost.

Python raises ``KeyboardInterrupt`` wherever it is. In a finalizer or in the callback of a weak
reference nobody can catch it: Python reports it and goes on, as if nothing had been pressed.
Raised while a class is made, it comes wrapped into another exception.
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
"""Seconds until an interrupt that was lost comes again."""


def keep_interrupts() -> None:
    """Let a lost ``KeyboardInterrupt`` come again, in place of a report."""
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
    else:  # this one wakes the main thread, should it sleep
        main = threading.main_thread().ident
        assert main is not None
        signal.pthread_kill(main, signal.SIGINT)


def is_interrupt(error: BaseException | None) -> bool:
    """Tell whether an exception is a ``KeyboardInterrupt``, or was caused by one."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None
