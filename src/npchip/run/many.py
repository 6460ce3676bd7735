"""Runs a program on several clips at once, in threads: compiled code gives up Python's lock."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterable
from functools import partial
from operator import length_hint
from threading import Condition, RLock, Thread
from typing import Final, cast

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.engines.base import Engine
from npchip.frames.arrays import ArrayFrames
from npchip.frames.feed import Frames, SourceFeed, frame_source
from npchip.frames.source import FrameSource
from npchip.run.job import Job
from npchip.run.result import RunResult

_SHORTEST: Final = 0.004
"""Seconds that a clip must have taken for further threads to help.

A run has about a millisecond of Python in it, which threads cannot do at the same time.
"""


def run_many(
    job: Job,
    engine: Engine,
    clips: Iterable[Frames],
    jobs: int | None,
    on_clip: Callable[[int, RunResult], None] | None,
) -> list[RunResult]:
    """See `Chip.run_many`.

    Args:
        job: the program.
        engine: its engine, for this thread; its state is where each run begins.
        clips: the frames of each run.
        jobs: number of threads at most; None for one for each core.
        on_clip: function called in this thread with each clip's number and result, in order.

    Raises:
        InputError: see `Chip.run_many`.
    """
    if engine.partner is not None:
        raise InputError(
            "NP108",
            "run_many: the chip has a partner, who cannot tell the clips apart",
            hint="connect a partner for each clip, and run the clips one after the other",
        )
    one = isinstance(clips, np.ndarray) and clips.ndim in {2, 3}
    if one or isinstance(clips, FrameSource | str | os.PathLike):
        raise InputError(
            "NP108", "run_many: expected several clips, found one", hint="pass a list of clips"
        )
    most = _cores() if jobs is None else jobs
    if most < 1:
        raise InputError("NP108", f"run_many: expected jobs from 1 on, found {jobs}")
    work = _Work(job, engine, clips, on_clip)
    try:
        return work.done(min(most, length_hint(clips, most)))
    finally:
        work.end()


def _cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _StoppedError(Exception):
    """Ends the run of a clip whose result nobody wants any more."""


class _Work:
    """The clips of one call, taken by its threads one by one; see `run_many`."""

    def __init__(
        self,
        job: Job,
        engine: Engine,
        clips: Iterable[Frames],
        on_clip: Callable[[int, RunResult], None] | None,
    ) -> None:
        self._job = job
        self._engine = engine
        self._start = engine.state.copy()
        self._clips = iter(clips)
        self._on_clip = on_clip
        self._changed = Condition(RLock())  # guards all below; notified of results
        self._begun = 0
        self._ended = False  # there are no more clips
        self._wanted: int | None = None  # clips below this number still count; None for all
        self._results: dict[int, RunResult] = {}
        self._failures: dict[int, BaseException] = {}
        self._threads: list[Thread] = []
        self._more = 0  # threads that may still be added
        self._since: float | None = None  # when the calling thread's clip read its first frames

    def done(self, most: int) -> list[RunResult]:
        """Run all clips in up to `most` threads."""
        self._more = most - 1
        shown: list[RunResult] = []
        while self._run_next(self._engine):
            self._show(shown)
        while self._show(shown):
            with self._changed:
                self._changed.wait_for(lambda: self._progress(len(shown)))
        return shown

    def end(self) -> None:
        """Set the engine back, stop all threads and wait for them."""
        with self._changed:
            self._ended, self._wanted = True, 0
        self._engine.state.assign(self._start)
        self._engine.refresh()
        for thread in self._threads:
            thread.join()

    # ---- the calling thread

    def _progress(self, shown: int) -> bool:
        return shown in self._results or shown in self._failures

    def _show(self, shown: list[RunResult]) -> bool:
        """Hand over the results that are next. Return whether others are still to come.

        Raises:
            Exception: the failure of the first clip that failed.
        """
        while True:
            index = len(shown)
            with self._changed:
                if index in self._failures:
                    raise self._failures[index]
                if index not in self._results:
                    return index < self._begun
                shown.append(self._results.pop(index))
            if self._on_clip is not None:
                self._on_clip(index, shown[-1])

    # ---- all threads

    def _run_next(self, engine: Engine, caught: type[BaseException] = Exception) -> bool:
        """Run the next clip. Return False if there is none.

        Args:
            engine: the engine of this thread.
            caught: exceptions that the calling thread is to raise in the order of the clips.
        """
        with self._changed:
            index = self._begun
            if self._ended:
                return False
            try:
                clip = next(self._clips, self)
            except caught as error:
                self._fail(index, error)
                return False
            if clip is self:
                self._ended = True
                return False
            self._begun += 1
        try:
            result = self._run(engine, index, cast("Frames", clip))
        except _StoppedError:
            return False
        except caught as error:
            self._fail(index, error)
            return False
        with self._changed:
            self._results[index] = result
            self._changed.notify_all()
        return True

    def _fail(self, index: int, error: BaseException) -> None:
        with self._changed:
            self._begun = max(self._begun, index + 1)
            self._failures[index] = _of_clip(error, index)
            self._ended = True
            self._wanted = index if self._wanted is None else min(self._wanted, index)
            self._changed.notify_all()

    def _run(self, engine: Engine, index: int, clip: Frames) -> RunResult:
        source = frame_source(clip, self._job.machine)
        check = partial(self._check, index)
        if engine is self._engine:
            self._add_threads()  # the clip before may have been of one batch
            self._since = None
            check = partial(self._check_here, index, isinstance(source, ArrayFrames))
        engine.state.assign(self._start)
        engine.refresh()
        return self._job.run(engine, _Feed(source, self._start.frames_taken, check))

    def _check(self, index: int) -> None:
        """Look around before frames are read."""
        if self._wanted is not None and index >= self._wanted:
            raise _StoppedError

    def _check_here(self, index: int, in_memory: bool) -> None:
        """Look around in the calling thread; by now the program has been compiled, for all."""
        self._check(index)
        if self._since is None:
            # To read or decode a batch may take long, and others need not wait for it.
            self._since = time.perf_counter() if in_memory else -math.inf
        self._add_threads()

    # ---- further threads

    def _add_threads(self) -> None:
        """Add threads if that pays: one, and with each look as many as there are."""
        if self._ended or self._since is None:
            return
        if time.perf_counter() - self._since < _SHORTEST:
            return
        for _ in range(min(self._more, len(self._threads) + 1)):
            self._more -= 1
            self._threads.append(Thread(target=self._help, name="npchip"))
            self._threads[-1].start()

    def _help(self) -> None:
        engine = self._engine.another()
        while engine is not None and not engine.notice and self._run_next(engine, BaseException):
            pass


class _Feed(SourceFeed):
    """A feed that can be stopped: `check` may raise before frames are read."""

    def __init__(self, source: FrameSource, start: int, check: Callable[[], None]) -> None:
        super().__init__(source, start)
        self._check = check

    def frames(self, index: int, most: int) -> NDArray[np.uint8]:
        """See `Feed.frames`."""
        self._check()
        return super().frames(index, most)


def _of_clip(error: BaseException, index: int) -> BaseException:
    """Return an error that names its clip."""
    if isinstance(error, InputError):
        named = InputError(error.code, f"clip {index}: {error.message}", hint=error.hint)
        return named.with_traceback(error.__traceback__)
    error.add_note(f"in clip {index}")
    return error
