"""State of the process that a test must leave as it was: later tests would fail otherwise."""

from __future__ import annotations

import contextlib
import gc
import os
import signal
from typing import Any, Final

try:
    import resource
except ImportError:  # it is there on Unix only
    _LIMITS: list[str] = []
else:
    _LIMITS = [name for name in dir(resource) if name.startswith("RLIMIT_")]

_SIGNALS: Final = sorted(signal.valid_signals())


def state() -> dict[str, Any]:
    """Return folder, signal handlers, the system's limits, and whether garbage is collected."""
    found: dict[str, Any] = {"folder": os.getcwd(), "garbage collection": gc.isenabled()}  # noqa: PTH109 - a text
    found |= {f"handler of signal {number}": signal.getsignal(number) for number in _SIGNALS}
    return found | {name: resource.getrlimit(getattr(resource, name)) for name in _LIMITS}


def changes(before: dict[str, Any]) -> list[str]:
    """Say what has changed since; put back what can be."""
    after = state()
    if after == before:
        return []
    os.chdir(before["folder"])
    (gc.enable if before["garbage collection"] else gc.disable)()
    for number in _SIGNALS:
        handler = before[f"handler of signal {number}"]
        if handler is not after[f"handler of signal {number}"] and handler is not None:
            with contextlib.suppress(OSError, ValueError):
                signal.signal(number, handler)
    return [
        f"{name}: {before[name]} became {now}" for name, now in after.items() if now != before[name]
    ]
