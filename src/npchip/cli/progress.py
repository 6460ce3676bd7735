"""A progress bar on standard error for long runs, shown only on a terminal."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rich.progress import Progress

    from npchip.run.result import FrameRecord

_PATIENCE_SECONDS = 1.0
_REFRESH_SECONDS = 0.1


@contextmanager
def frame_progress(total: int | None) -> Iterator[Callable[[FrameRecord], None] | None]:
    """Yield a function to call after every frame; None if standard error is no terminal.

    Args:
        total: number of frames, if known.
    """
    if not sys.stderr.isatty():
        yield None
        return
    bar: Progress | None = None
    done = 0
    due = time.monotonic() + _PATIENCE_SECONDS

    def on_frame(_record: FrameRecord) -> None:
        nonlocal bar, done, due
        done += 1
        now = time.monotonic()
        if now < due:
            return
        due = now + _REFRESH_SECONDS
        if bar is None:
            bar = _progress_bar()
            bar.add_task("frames", total=total, completed=done)
            bar.start()
        bar.update(bar.task_ids[0], completed=done)

    try:
        yield on_frame
    finally:
        if bar is not None:
            bar.stop()


@contextmanager
def step_progress(total: int) -> Iterator[Callable[[str, int], None]]:
    """Yield a function to call with the name of a step and the number of steps done.

    Args:
        total: greatest number of steps.
    """
    if not sys.stderr.isatty():
        yield lambda _name, _done: None
        return
    bar = _progress_bar()
    task = bar.add_task("", total=total)
    with bar:
        yield lambda name, done: bar.update(task, description=name, completed=done)


def _progress_bar() -> Progress:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )
