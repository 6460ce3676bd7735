"""The past of a session: snapshots, edits, the times at which frames began.

Time is the number of instructions executed since reset. A state follows from the program, the
frames and the edits alone, so that any moment is reached again from a snapshot before it.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from npchip.debugger.values import Cell, One, Pixel

if TYPE_CHECKING:
    from npchip import Chip, Snapshot

BUDGET = 96 << 20
"""Bytes that snapshots may take."""
SPACING = 16_384
"""Instructions between two snapshots when stepping."""
_NEWEST = 32
"""Snapshots next to the present, which are not thinned out."""
_SEND_BYTES = 700
_OVERHEAD_BYTES = 4_096


@dataclass(frozen=True)
class Edit:
    """A value that was set by hand: of one place, or of a cell in all NPs.

    Attributes:
        place: what was set.
        value: to what.
        old: what it was, shape () or (NP rows, NP columns).
    """

    place: Cell | One | Pixel
    value: int
    old: NDArray[np.uint8]

    def apply(self, chip: Chip) -> None:
        """Set it."""
        match self.place:
            case Cell():
                self.place.plane(chip)[...] = self.value
            case One(cell=cell, row=row, column=column):
                cell.plane(chip)[row, column] = self.value
            case Pixel(row=row, column=column):
                frame = chip.frame
                assert frame is not None
                frame[row, column] = self.value
                chip.frame = frame

    def reaches(self, place: One | Pixel) -> bool:
        """Return whether it has set a place."""
        if isinstance(self.place, Cell):
            return isinstance(place, One) and place.cell == self.place
        return self.place == place

    def old_of(self, place: One | Pixel) -> int:
        """Return the value that a place which it reaches had before."""
        if isinstance(self.place, Cell) and isinstance(place, One):
            return int(self.old[place.row, place.column])
        return int(self.old)


@dataclass(frozen=True)
class Moment:
    """A snapshot with what can be known about it without going there.

    Attributes:
        time: instructions executed.
        pc: next address.
        executions: int64, shape (words,): how often each address was executed before.
    """

    snapshot: Snapshot
    time: int
    pc: int
    executions: NDArray[np.int64]
    size: int


@dataclass
class History:
    """Snapshots by time, edits by time, and the times just after each expose.

    Attributes:
        edits: made at a time, in their order.
        exposed: of every frame since reset: the time just after its expose.
        thinned: how often snapshots have been thinned out.
    """

    edits: dict[int, list[Edit]] = field(default_factory=dict)
    exposed: array[int] = field(default_factory=lambda: array("q"))
    thinned: int = 0
    _times: list[int] = field(default_factory=list)
    _moments: dict[int, Moment] = field(default_factory=dict)
    _bytes: int = 0

    def keep(self, chip: Chip) -> None:
        """Remember the chip as it is now."""
        time = chip.instructions
        if time in self._moments:
            return
        executions = chip.executions
        arrays = (chip.registers, chip.memory, *chip.flags.values(), chip.active, executions)
        size = sum(item.nbytes for item in arrays) + executions.nbytes
        size += chip.machine.rows * chip.machine.cols
        size += _SEND_BYTES * len(chip.sends) + _OVERHEAD_BYTES
        moment = Moment(chip.snapshot(), time, chip.pc, executions, size)
        self._times.insert(bisect_left(self._times, time), time)
        self._moments[time] = moment
        self._bytes += size
        while self._bytes > BUDGET and len(self._times) > 2:
            self._thin(time)

    def _thin(self, now: int) -> None:
        """Forget every other snapshot but the first and those near `now`.

        What has been thinned before is thinned again: the farther away, the fewer are left.
        """
        self.thinned += 1
        near = bisect_left(self._times, now)
        newest = range(max(1, near - _NEWEST), near + 2) if len(self._times) > 2 * _NEWEST else ()
        for index, time in reversed(list(enumerate(self._times))):
            if index % 2 and index not in newest and time != now:
                self._bytes -= self._moments.pop(time).size
                del self._times[index]

    def before(self, time: int) -> Moment:
        """The last snapshot at or before a time; there always is the first one."""
        return self._moments[self._times[bisect_right(self._times, time) - 1]]

    def moments(self, until: int) -> list[Moment]:
        """The snapshots before a time, the newest first."""
        return [
            self._moments[time] for time in reversed(self._times[: bisect_left(self._times, until)])
        ]

    def due(self, time: int, spacing: int = SPACING) -> int:
        """Return the time at which the next snapshot after `time` is due."""
        return self.before(time).time + spacing

    def frame_at(self, time: int) -> int:
        """Frames that had been exposed at a time, as far as they are known."""
        return bisect_right(self.exposed, time)

    def note_exposed(self, frame: int, time: int) -> None:
        """Frame number `frame` was exposed just before `time`."""
        if frame == len(self.exposed):
            self.exposed.append(time)

    def edit(self, time: int, edit: Edit) -> int:
        """Record an edit at a time: what came after has not happened.

        A snapshot of this very time is outdated too; `keep` the edited state instead.

        Returns:
            How many later edits have been forgotten.
        """
        later = [at for at in self.edits if at > time]
        forgotten = sum(len(self.edits.pop(at)) for at in later)
        self.edits.setdefault(time, []).append(edit)
        keep = bisect_left(self._times, time)
        for at in self._times[keep:]:
            self._bytes -= self._moments.pop(at).size
        del self._times[keep:]
        del self.exposed[self.frame_at(time) :]
        return forgotten

    @property
    def size(self) -> int:
        """Bytes that the snapshots take."""
        return self._bytes

    def __len__(self) -> int:
        return len(self._times)
