"""Batches on a Dask cluster: clips travel by content, workers need only npchip."""

from __future__ import annotations

import logging
from collections import OrderedDict
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError
from typing import Any, Final

import numpy as np
from distributed import Client, Future, KilledWorker, wait

from npchip.base.errors import InputError
from npchip.machine import Machine
from npchip.sweep.content import version
from npchip.sweep.model import DrawnClip
from npchip.sweep.work import Batch, Done, Footage, OtherVersionError, Task, do, read_footage

_PATIENCE: Final = 30
"""Seconds to wait for the scheduler and for a first worker."""
_LOOK: Final = 1
"""Seconds between two looks at whether the scheduler is there."""
_TALKING: Final = ("distributed", "distributed.client", "tornado", "tornado.application", "asyncio")
"""Names of the loggers of Dask's client."""
_CLIPS: Final = 48
"""Clips that the cluster keeps at the same time."""


class Cluster:
    """A Dask cluster that exists.

    Args:
        address: address of its scheduler, such as ``tcp://host:8786``.

    Raises:
        InputError: NP648 there is no scheduler or no worker, NP649 a worker has another version
            of npchip, or none.
    """

    def __init__(self, address: str) -> None:
        self._address = address
        for name in _TALKING:  # what they say with tracebacks is said once, in an error
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        try:
            self._client = Client(address, timeout=_PATIENCE, set_as_default=False)
            self._client.wait_for_workers(1, timeout=_PATIENCE)
        except (OSError, TimeoutError, ValueError) as error:
            raise InputError(
                "NP648",
                f"--scheduler {address}: no scheduler, or one without workers ({error})",
                hint="dask scheduler, and dask worker tcp://HOST:8786 on each machine",
            ) from None
        found = self._client.run(_version_there, on_error="return")
        _check_versions({name: str(item) for name, item in found.items()})
        self._clips: OrderedDict[str, Any] = OrderedDict()

    @property
    def workers(self) -> int:
        """Number of threads of all workers."""
        return max(1, sum(map(int, self._client.nthreads().values())))

    def close(self) -> None:
        """Leave the cluster, which goes on."""
        self._client.close(timeout=2)

    def run(self, batches: Iterable[Batch]) -> Iterator[list[Done]]:
        """Yield the results of batches as they come.

        Raises:
            InputError: NP648 the scheduler is gone, NP649 as above.
        """
        waiting = iter(batches)
        pending: dict[Future[Any], Batch] = {}
        again: list[Batch] = []
        more = True
        while more or pending or again:
            room = 2 * self.workers if self._alive() else 0
            while len(pending) < room and (more or again):
                batch = again.pop() if again else next(waiting, None)
                if batch is None:
                    more = False
                    break
                pending[self._submit(batch)] = batch
            self._check_alive()
            for future in self._finished(pending):
                batch = pending.pop(future)
                try:
                    yield future.result()
                except CancelledError:  # with the worker a clip was lost: send it once more
                    self._check_alive()
                    self._clips.clear()
                    again.append(batch)
                except KilledWorker as error:
                    yield [_killed(task, error) for task in batch.tasks]
                except OtherVersionError as error:
                    _check_versions({"a worker": str(error)})

    def _finished(self, pending: dict[Future[Any], Batch]) -> list[Future[Any]]:
        if not pending:
            return []
        try:
            with self._client.as_current():
                found = wait(list(pending), timeout=_LOOK, return_when="FIRST_COMPLETED")
            return list(found.done)
        except TimeoutError:
            return []
        except CancelledError:
            self._check_alive()
            return [future for future in pending if future.status == "cancelled"]

    def _alive(self) -> bool:
        return bool(self._client.status == "running")

    def _check_alive(self) -> None:
        if not self._alive():
            raise InputError(
                "NP648",
                f"--scheduler {self._address}: the scheduler is gone",
                hint="what is done is kept: start it, and run the same command again",
            )

    def _submit(self, batch: Batch) -> Future[Any]:
        footage = None
        if batch.machine is not None and any(task.clip for task in batch.tasks):
            footage = [self._footage(task, batch, batch.machine) for task in batch.tasks]
        return self._client.submit(do, batch, footage, pure=False)

    def _footage(self, task: Task, batch: Batch, machine: Machine) -> Any:
        """Return a clip on the cluster; None for one that workers draw."""
        if task.clip is None or isinstance(task.clip, DrawnClip):
            return None
        if task.clip_key in self._clips:
            self._clips.move_to_end(task.clip_key)
            return self._clips[task.clip_key]
        read: Footage | InputError
        try:
            read = _whole(read_footage(task.clip, machine, batch.first, batch.fit))
        except InputError as error:
            read = error
        self._clips[task.clip_key] = self._client.scatter(read)
        if len(self._clips) > _CLIPS:
            self._clips.popitem(last=False)
        return self._clips[task.clip_key]


def _whole(footage: Footage) -> Footage:
    """Return a clip with all its frames in memory, as the worker has no file."""
    if isinstance(footage.frames, np.ndarray):
        return footage
    return Footage(np.stack(list(footage.frames)), footage.truth)


def _version_there() -> str:
    """Return the version of the worker that calls it."""
    return version()


def _killed(task: Task, error: Exception) -> Done:
    row = {"status": "failed", "error": f"error: workers died of it again and again: {error}"}
    return Done(task.key, row, again=True)


def _check_versions(found: dict[str, str]) -> None:
    others = {name: item for name, item in found.items() if item != version()}
    if others:
        listed = ", ".join(f"{name} has {item}" for name, item in sorted(others.items())[:5])
        raise InputError(
            "NP649",
            f"workers have another npchip than {version()}: {listed}",
            hint=f"pip install npchip=={version()} on every worker",
        )
