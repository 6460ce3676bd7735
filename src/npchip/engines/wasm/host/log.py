"""Reads a program's sends from the memory of its module."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from npchip.engines.batch import FrameBatch, Send, SendLog, Sites
from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.host.instance import Bytes
from npchip.engines.wasm.translation import Translation
from npchip.machine import PIXELS

_PICTURE = PIXELS * PIXELS
_FORMS = 64
"""Forms that are remembered at most."""


@dataclass(eq=False)
class _Form:
    """Sends that are the same in each of some frames, but for the bytes sent.

    Attributes:
        rest: entries that are not part of an array.
        planes: planes of those.
        arrays: for the port of each output that is an array, the number of its first plane, and
            the distance of the planes of a picture; 0 for a plane.
    """

    rest: list[int]
    planes: list[int]
    arrays: dict[int, tuple[int, int]]


class Log:
    """The sends of one batch.

    Args:
        translation: the program.
        part: returns a view of the memory, given its offset and size.
        records: cycles, instructions and end of the log of each frame: int64, shape (n, 3).
        assemble: writes pictures as frames to `Layout.pictures`; see `Helpers`.
    """

    def __init__(
        self,
        translation: Translation,
        part: Callable[[int, int], Bytes],
        records: NDArray[np.int64],
        assemble: Callable[[int, int, int, int], Any],
    ) -> None:
        self._layout = translation.layout
        self._kinds = translation.kinds
        self._part = part
        self._words = part(0, at.CONTROL_BYTES).view(np.int32)
        self._records = records
        self._assemble = assemble
        sites = [(site.address, site.port, planes) for site, planes in translation.sites]
        self._sites = Sites(*np.array(sites, np.int64).reshape(-1, 3).T.copy())
        self._forms: dict[bytes, _Form] = {}
        self.clear([])

    def clear(self, prefix: list[Send]) -> None:
        """Begin a batch with an empty log.

        Args:
            prefix: sends of the first frame that were made before the run began.
        """
        self._prefix = prefix
        self._open: tuple[Any, Bytes] | None = None  # drained from the frame that is not complete
        self._move(0, 0)

    def complete(self) -> FrameBatch | None:
        """Return the frames that are complete since the last call; None if there are none.

        Their arrays are in the module's memory, and valid until `discard`.
        """
        where, closed = self._layout, int(self._words[at.CLOSED // 4])
        entries, planes = self._held()
        self._done = 0, 0
        if not closed:
            return None
        ends = self._records[:closed, 2] & (1 << 32) - 1  # only these are written
        ends = (ends - where.log) // at.ENTRY
        taken = int(ends[-1])
        rest = self._sites.planes[entries[taken:] >> 8].sum() if taken < len(entries) else 0
        self._done = taken, len(planes) - int(rest)
        log = self._log_of(ends, entries[:taken], planes[: self._done[1]])
        if self._prefix:
            log = log.preceded_by(self._prefix)
        self._prefix, self._open = [], None
        cycles, instructions = self._records[:closed, :2].T.copy()
        return FrameBatch(cycles, instructions, log)

    def discard(self) -> None:
        """Drop what `complete` has returned, and empty the module's log if the rest fills it."""
        where = self._layout
        entries, planes = self._held()
        entries, planes = entries[self._done[0] :].copy(), planes[self._done[1] :].copy()
        if where.has_room(len(entries), len(planes)):
            self._part(where.log, entries.nbytes)[:] = entries.view(np.uint8)
            self._part(where.data, planes.nbytes)[:] = planes.reshape(-1)
            self._move(len(entries), len(planes))
        else:
            self._open = self._with_open(entries, planes)
            self._move(0, 0)

    def pending_sends(self) -> list[Send]:
        """Return the sends of the current frame; all others must have been discarded."""
        entries, planes = self._with_open(*self._held())
        if not len(entries):
            return [*self._prefix]
        sends = self._sends(np.array([len(entries)]), entries, planes, {}).sends(0, len(entries))
        return [*self._prefix, *sends]

    def _held(self) -> tuple[NDArray[np.uint32], Bytes]:
        """Return the entries and planes in the module, not copies."""
        where = self._layout
        log_end, data_end = (int(self._words[word // 4]) for word in (at.LOG_END, at.DATA_END))
        entries = self._part(where.log, log_end - where.log).view(np.uint32)
        return entries, self._part(where.data, data_end - where.data).reshape(-1, where.stride)

    def _move(self, entries: int, planes: int) -> None:
        """Tell the module how many entries and planes of the open frame its log holds."""
        where = self._layout
        self._words[at.CLOSED // 4] = 0
        self._words[at.LOG_END // 4] = where.log + at.ENTRY * entries
        self._words[at.DATA_END // 4] = where.data + where.stride * planes

    def _with_open(self, entries: NDArray[np.uint32], planes: Bytes) -> tuple[Any, Bytes]:
        if self._open is None:
            return entries, planes
        before, planes_before = self._open
        return np.concatenate([before, entries]), np.concatenate([planes_before, planes])

    def _log_of(
        self, ends: NDArray[np.int64], entries: NDArray[np.uint32], planes: Bytes
    ) -> SendLog:
        """Return complete frames as a log."""
        plain = self._open is None and not self._prefix and len(planes)
        form = self._form_of(ends, entries) if plain else None
        if form is None:
            before = 0 if self._open is None else len(self._open[0])
            return self._sends(ends + before, *self._with_open(entries, planes), {})
        where, count = self._layout, len(ends)
        block = entries.reshape(count, -1)
        by_frame = planes.reshape(count, -1, where.stride)
        arrays = {}
        for port, (first, distance) in form.arrays.items():
            if distance:
                start = where.data + first * where.stride
                self._assemble(start, distance * where.stride, by_frame[0].size, count)
                shape = count, where.machine.rows, where.machine.cols
                array = self._part(where.pictures, count * where.frame_bytes).reshape(shape)
            else:
                array = by_frame[:, first, : where.lanes].reshape(count, *where.machine.geometry)
            arrays[port] = array.copy() if len(form.arrays) > 1 else array
        rest = block[:, form.rest].reshape(-1)
        steps = len(form.rest) * np.arange(1, count + 1)
        kept = by_frame[:, form.planes].reshape(-1, where.stride)
        return self._sends(steps, rest, kept, arrays)

    def _form_of(self, ends: NDArray[np.int64], entries: NDArray[np.uint32]) -> _Form | None:
        """Return the form that all frames have; None if they differ or have no arrays."""
        each = int(ends[0])
        if not each or not np.array_equal(ends, each * np.arange(1, len(ends) + 1)):
            return None
        block = entries.reshape(-1, each)
        if len(block) > 1 and ((block[1:] ^ block[0]) >> 8).any():
            return None
        sites = block[0] >> 8
        key = sites.tobytes()
        if key not in self._forms:
            if len(self._forms) == _FORMS:  # batches of a frame, each of which sends in its own way
                self._forms.clear()
            self._forms[key] = self._read_form(sites)
        form = self._forms[key]
        return form if form.arrays else None

    def _read_form(self, sites: NDArray[np.uint32]) -> _Form:
        ports, counts = self._sites.port[sites], self._sites.planes[sites]
        firsts = np.cumsum(counts) - counts
        arrays = {}
        for port in np.unique(ports).tolist():
            of_port = ports == port
            places = firsts[of_port]
            steps = np.unique(np.diff(places)).tolist()
            kind = self._kinds.get(port, "plane")
            if not counts[of_port].all():  # the byte is in the entry
                continue
            if kind == "plane":
                arrays[port] = int(places[-1]), 0
            elif kind == "picture" and len(places) == _PICTURE and len(steps) == 1:
                arrays[port] = int(places[0]), steps[0]
        rest = np.flatnonzero(~np.isin(ports, [*arrays]))
        planes = [
            plane for entry in rest for plane in range(firsts[entry], firsts[entry] + counts[entry])
        ]
        return _Form(rest.tolist(), planes, arrays)

    def _sends(
        self,
        ends: NDArray[np.int64],
        entries: NDArray[np.uint32],
        planes: Bytes,
        arrays: dict[int, Bytes],
    ) -> SendLog:
        return SendLog(
            ends=ends,
            site=entries >> 8,
            value=entries.astype(np.uint8),
            planes=planes[:, : self._layout.lanes],
            sites=self._sites,
            shape=self._layout.machine.geometry,
            arrays=arrays,
        )
