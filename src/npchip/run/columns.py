"""The outputs of many frames at once: `outputs.read_outputs` with whole columns.

Frames whose sends cannot be read as their ``.output`` lines say are only found here; what is wrong
with them is said there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.engines.batch import SendLog
from npchip.machine.layout import to_frames
from npchip.program.model import Output, Program
from npchip.run.outputs import PICTURE_SENDS


class Column(NamedTuple):
    """One output of the frames of a batch.

    Attributes:
        kind: as in the ``.output`` line.
        present: bool, shape (n,): False where nothing was sent; None where all frames have one.
        values: of the frames where something was sent, in order: integers (m,) for a scalar,
            uint8 (m, rows, columns) for a plane or picture, m lists for a list.
    """

    kind: str
    present: NDArray[np.bool_] | None
    values: Any


class _Sends(NamedTuple):
    """The sends of one port: their numbers in the log, and their frames."""

    numbers: NDArray[np.int64]
    frame: NDArray[np.int64]

    def some(self, which: NDArray[np.bool_]) -> _Sends:
        return _Sends(self.numbers[which], self.frame[which])

    def last(self) -> _Sends:
        """The last send of each frame."""
        return self.some(np.diff(self.frame, append=-1) != 0)


def read_scalars(program: Program, log: SendLog, count: int) -> Mapping[str, Column] | None:
    """As `read_columns`, fast, where all is simple.

    That is: scalars only, every send uniform, and the same ports in the same order in all frames.
    """
    if log.sites.planes.any() or any(output.kind != "scalar" for output in program.outputs):
        return None
    each = int(log.ends[0]) if count else 0
    if not each or not np.array_equal(log.ends, np.arange(1, count + 1) * each):
        return None
    ports = log.port.reshape(count, each)
    if not (ports == ports[0]).all():
        return None
    place = {port: index for index, port in enumerate(ports[0].tolist())}  # the last one counts
    if place.keys() != {output.port for output in program.outputs}:
        return None
    values = log.value.reshape(count, each)
    return {
        output.name: Column("scalar", None, values[:, place[output.port]])
        for output in program.outputs
    }


def first_unreadable(program: Program, log: SendLog, count: int) -> int:
    """Number of the first of `count` frames that cannot be read; `count` if all can."""
    first = count
    for output in program.outputs:
        sends = _of_port(log, output.port)
        if output.kind == "picture":
            bad = _miscounted(sends, count, PICTURE_SENDS)
        elif output.kind == "plane":
            continue
        else:
            heard, _, agreed = _scalars(log, sends)
            sends, agreed = sends.some(heard), agreed[heard]
            if output.kind == "scalar":
                last = np.diff(sends.frame, append=-1) != 0
                sends, agreed = sends.some(last), agreed[last]
            bad = sends.frame[~agreed]
            if output.kind == "scalar16":
                bad = np.concatenate([bad, _miscounted(sends, count, 2)])
        first = min(first, int(bad.min(initial=count)))
    return first


def read_columns(program: Program, log: SendLog, count: int) -> Mapping[str, Column]:
    """Outputs of `count` frames by name, ports without a name among them; all can be read."""
    columns = {output.name: _column(output, log, count) for output in program.outputs}
    named = {output.port for output in program.outputs}
    for port in np.unique(log.sites.port).tolist():
        if port not in named:
            sends = _of_port(log, port)
            if len(sends.numbers):
                columns[f"port{port}"] = _planes(log, sends, count)
    return columns


def _of_port(log: SendLog, port: int) -> _Sends:
    numbers = np.flatnonzero(log.port == port)
    return _Sends(numbers, log.frame[numbers])


def _miscounted(sends: _Sends, count: int, wanted: int) -> NDArray[np.int64]:
    """Frames with some sends, but not as many as wanted."""
    counts = np.bincount(sends.frame, minlength=count)
    return np.flatnonzero((counts != 0) & (counts != wanted))


def _scalars(
    log: SendLog, sends: _Sends
) -> tuple[NDArray[np.bool_], NDArray[np.uint8], NDArray[np.bool_]]:
    """For each send whether any NP was active, what the first active one sent, and agreement."""
    values = log.value[sends.numbers]
    heard = np.ones(len(values), np.bool_)
    agreed = np.ones(len(values), np.bool_)
    different = np.flatnonzero(log.sites.planes[log.site[sends.numbers]])
    if len(different):
        data = log.bytes_of(sends.numbers[different])
        active = log.active_of(sends.numbers[different])
        heard[different] = active.any(axis=1)
        first = data[np.arange(len(data)), active.argmax(axis=1)]
        values[different] = first
        agreed[different] = ((data == first[:, None]) | ~active).all(axis=1)
    return heard, values, agreed


def _column(output: Output, log: SendLog, count: int) -> Column:
    sends = _of_port(log, output.port)
    if output.kind == "plane":
        return _planes(log, sends, count)
    if output.kind == "picture":
        planes = log.bytes_of(sends.numbers).reshape(-1, PICTURE_SENDS, *log.shape)
        return Column("picture", _present(sends, count), to_frames(planes))
    heard, values, _ = _scalars(log, sends)
    sends, values = sends.some(heard), values[heard]
    present = _present(sends, count)
    if output.kind == "list":
        ends = np.cumsum(np.bincount(sends.frame, minlength=count)[present])
        lists = [part.tolist() for part in np.split(values, ends[:-1])] if len(ends) else []
        return Column("list", present, lists)
    if output.kind == "scalar16":
        pairs = values.reshape(-1, 2).astype(np.int32)
        return Column("scalar16", present, pairs[:, 0] | pairs[:, 1] << 8)
    last = np.diff(sends.frame, append=-1) != 0
    return Column("scalar", present, values[last].astype(np.int32))


def _planes(log: SendLog, sends: _Sends, count: int) -> Column:
    last = sends.last()
    return Column(
        "plane", _present(sends, count), log.bytes_of(last.numbers).reshape(-1, *log.shape)
    )


def _present(sends: _Sends, count: int) -> NDArray[np.bool_]:
    present = np.zeros(count, np.bool_)
    present[sends.frame] = True
    return present
