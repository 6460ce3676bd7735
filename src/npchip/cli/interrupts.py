"""Signals that always take effect and leave nothing behind: Ctrl-C, TERM and HUP.

While modules are imported, and after the work, they end the process at once. In between they raise
``KeyboardInterrupt``. Python may do that anywhere: in a finalizer or the callback of a weak
reference it only reports it and continues; while a class is made, another exception wraps it.
"""

from __future__ import annotations

import atexit
import os
import sys

TYPE_CHECKING = False  # typing takes long to import
if TYPE_CHECKING:
    import signal
    from sys import UnraisableHookArgs
    from typing import Final
else:
    import _signal as signal  # without enumerations, which take longer to import than all of this

_SOON: Final = 0.01
"""Seconds until a lost interrupt is repeated."""
_ENDING: Final = {
    name: getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
}
_taken: list[int] = []
_received: int = 0
_code: int | None = None


def end_at_once() -> None:
    """Let the signals end the process; those that its parent ignores stay ignored."""
    atexit.register(_leave)  # runs last
    for number in _ENDING.values():
        if signal.getsignal(number) in {signal.SIG_DFL, signal.default_int_handler}:
            _taken.append(number)
            signal.signal(number, _end)


def _end(number: int, _frame: object) -> None:
    os.write(2, b"interrupted\n")
    os._exit(128 + number)


class Raising:
    """Context in which a signal of `end_at_once` raises ``KeyboardInterrupt``."""

    def __enter__(self) -> None:
        for number in _taken:
            signal.signal(number, _raise)

    def __exit__(self, *_: object) -> None:
        for number in _taken:
            signal.signal(number, _end)


def _raise(number: int, _frame: object) -> None:
    from npchip.base.files import raise_soon

    global _received  # noqa: PLW0603 - of the process, as signals are
    _received = number
    raise_soon(KeyboardInterrupt())


def leave_with(code: object) -> None:
    """Note the exit code of a process that has done its work.

    Python's own end would take it back where a signal comes late, or came where text is executed.
    """
    global _code  # noqa: PLW0603 - of the process
    _code = code if isinstance(code, int) else None


def _leave() -> None:
    if _code is not None:
        for stream in (sys.stdout, sys.stderr):
            try:  # noqa: SIM105 - contextlib would be imported before signals are seen to
                stream.flush()
            except (OSError, ValueError):
                pass
        os._exit(_code)


def exit_code() -> int | None:
    """Return the exit code of a process that the last signal has ended; None without any."""
    return 128 + _received if _received else None


def keep_interrupts() -> None:
    """Repeat a ``KeyboardInterrupt`` that was lost, instead of reporting it."""
    import threading

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
    import _thread
    import threading

    if sys.platform == "win32":
        _thread.interrupt_main()
    else:  # a signal also wakes a sleeping main thread
        main = threading.main_thread().ident
        assert main is not None
        signal.pthread_kill(main, _received or signal.SIGINT)


def is_interrupt(error: BaseException | None) -> bool:
    """Return whether an exception is a ``KeyboardInterrupt`` or was caused by one.

    After a signal any may be: a decoder in C that cannot go on raises one of its own.
    """
    if _received:
        return True
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None
