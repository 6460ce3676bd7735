"""Reads a program's sends from the memory of its module."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from npchip.engines.batch import FrameBatch, Send, SendLog, Sites
from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.host.instance import Bytes
from npchip.engines.wasm.translate.summary import Site


class Log:
    """The sends of one batch.

    Args:
        layout: addresses in the module's memory.
        part: returns a view of the memory, given its offset and size.
        records: cycles, instructions and end of the log of each frame: int64, shape (ring, 3).
        sites: output instructions by number, with the number of planes that each send has.

    Attributes:
        closed: number of complete frames that have been drained.
    """

    def __init__(
        self,
        layout: Layout,
        part: Callable[[int, int], Bytes],
        records: NDArray[np.int64],
        sites: Sequence[tuple[Site, int]],
    ) -> None:
        self._layout = layout
        self._part = part
        self._words = part(0, at.CONTROL_BYTES).view(np.int32)
        self._records = records
        self._sites = Sites(
            np.array([site.address for site, _ in sites], np.int64),
            np.array([site.port for site, _ in sites], np.int64),
            np.array([planes for _, planes in sites], np.int64),
        )
        self.forget()

    def forget(self) -> None:
        """Drop everything that has been drained in this batch."""
        self._entries: list[Bytes] = []
        self._data: list[Bytes] = []
        self._logged = 0  # entries that were drained
        self.closed = 0

    def clear(self) -> None:
        """Begin a batch with an empty log."""
        self.forget()
        self._words[at.LOG_END // 4] = self._layout.log
        self._words[at.DATA_END // 4] = self._layout.data

    def drain(self) -> None:
        """Copy the sends out of the module and empty its log."""
        where = self._layout
        closed = max(0, int(self._words[at.POSITION // 4]) - 1)
        ends = self._records[self.closed : closed, 2]  # becomes entries since the batch began
        ends &= (1 << 32) - 1  # the module does not write the upper half
        ends -= where.log
        ends >>= at.ENTRY.bit_length() - 1
        ends += self._logged
        self.closed = closed
        log_end, data_end = (int(self._words[word // 4]) for word in (at.LOG_END, at.DATA_END))
        entries = self._part(where.log, log_end - where.log).copy()
        self._entries.append(entries)
        self._data.append(self._part(where.data, data_end - where.data).copy())
        self._logged += len(entries) // at.ENTRY
        self._words[at.LOG_END // 4] = where.log
        self._words[at.DATA_END // 4] = where.data

    def batch(self, pending: tuple[int, int] | None, prefix: list[Send]) -> FrameBatch:
        """Return the complete frames of the batch.

        Args:
            pending: cycles and instructions of the current frame, if it counts as complete.
            prefix: sends of the first frame that were made before the run began.
        """
        self.drain()
        count = self.closed
        if pending is not None:
            self._records[count] = *pending, self._logged
            count += 1
        records = self._records[:count].copy()
        log = self._sends(records[:, 2])
        if prefix and count:
            log = log.preceded_by(prefix)
        return FrameBatch(records[:, 0], records[:, 1], log)

    def pending_sends(self) -> list[Send]:
        """Return the sends of the current frame."""
        self.drain()
        start = int(self._records[self.closed - 1, 2]) if self.closed else 0
        return self._sends(np.array([start, self._logged])).sends(start, self._logged)

    def _sends(self, ends: NDArray[np.int64]) -> SendLog:
        entries = np.concatenate(self._entries).view(np.uint32)[: ends[-1] if len(ends) else 0]
        data = np.concatenate(self._data).reshape(-1, self._layout.stride)
        return SendLog(
            ends=ends,
            site=entries >> 8,
            value=entries.astype(np.uint8),
            planes=data[:, : self._layout.lanes],
            sites=self._sites,
            shape=self._layout.machine.geometry,
        )
