"""No garbage collection for a while."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uncollected() -> Iterator[None]:
    """Let Python's collector wait: of what a translation makes, nearly all lives until it ends.

    The collector would look through it dozens of times, and on the way through all that the process
    holds besides. It is switched on again afterwards if it was on. Other threads go without it as
    well, for the tenth of a second that most translations take less than.
    """
    enabled = gc.isenabled()
    try:
        gc.disable()
        yield
    finally:
        if enabled:
            gc.enable()
