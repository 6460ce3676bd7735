"""Batches on the cores of this machine, by joblib's processes."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterable, Iterator

from npchip.base.errors import InputError
from npchip.sweep.work import Batch, Done, do, forget


def cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run(batches: Iterable[Batch], jobs: int) -> Iterator[list[Done]]:
    """Yield the results of batches as they come.

    Args:
        batches: the batches, which are taken when a worker will have time for them.
        jobs: number of processes; 0 for this process.

    Raises:
        InputError: NP650 a process was killed.
    """
    if jobs == 0:
        try:
            yield from map(do, batches)
        finally:
            forget()
        return
    from joblib import Parallel, delayed  # noqa: PLC0415 - with an extra
    from joblib.externals.loky import get_reusable_executor  # noqa: PLC0415
    from joblib.externals.loky.process_executor import TerminatedWorkerError  # noqa: PLC0415

    parallel = Parallel(
        n_jobs=jobs,
        return_as="generator_unordered",
        batch_size=1,
        pre_dispatch="2 * n_jobs",
        max_nbytes=None,
        initializer=_leave_interrupts,
    )
    try:
        yield from parallel(delayed(do)(batch) for batch in batches)
    except TerminatedWorkerError:
        raise InputError(
            "NP650",
            "a process of the sweep was killed, perhaps because memory ran out",
            hint="what is done is kept: run the same command again, with a smaller --jobs",
        ) from None
    finally:
        get_reusable_executor().shutdown(wait=False, kill_workers=True)


def _leave_interrupts() -> None:
    """Let Ctrl-C end the process that collects the results, which then ends this one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
