"""The past of a session: snapshots, edits, the times at which frames began.

Time is the number of instructions executed since reset. The program, the frames and the edits
determine every state, so any moment can be reached again from an earlier snapshot.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from npchip import Chip, Snapshot
from npchip.debugger.values import Cell, Location, One, Pixel

BUDGET = 96 << 20
"""Largest size of all snapshots, in bytes."""
SPACING = 16_384
"""Instructions between two snapshots when stepping."""
_NEWEST = 32
"""Snapshots next to the present, which are not thinned out."""
_SEND_BYTES = 700
_OVERHEAD_BYTES = 4_096


@dataclass(frozen=True)
class Edit:
    """A value set by hand in one location, or in a cell of all NPs.

    Attributes:
        target: the location or cell.
        value: the new value.
        old: the value before, shape () or (NP rows, NP columns).
    """

    target: Cell | Location
    value: int
    old: NDArray[np.uint8]

    def apply(self, chip: Chip) -> None:
        """Set the value."""
        match self.target:
            case Cell() as cell:
                cell.plane(chip)[...] = self.value
            case One(cell=cell, row=row, column=column):
                cell.plane(chip)[row, column] = self.value
            case Pixel(row=row, column=column):
                frame = chip.frame
                assert frame is not None
                frame[row, column] = self.value
                chip.frame = frame

    def reaches(self, location: Location) -> bool:
        """Return whether it sets a location."""
        return self.target in (location, getattr(location, "cell", None))

    def old_of(self, location: Location) -> int:
        """Return the value that a location had before, which the edit reaches."""
        return int(self.old[location.row, location.column] if self.old.ndim else self.old)


@dataclass(frozen=True)
class Moment:
    """A snapshot, and facts about it that need no restoring.

    Attributes:
        time: instructions executed.
        pc: next address.
        executions: executions of each address before, int64, shape (words,).
        size: bytes that the snapshot takes.
    """

    snapshot: Snapshot
    time: int
    pc: int
    executions: NDArray[np.int64]
    size: int


@dataclass
class History:
    """The snapshots, edits and exposes of a session.

    Attributes:
        edits: edits by time, in the order in which they were made.
        exposed: for every frame since reset, the time just after its expose.
        size: bytes that the snapshots take.
    """

    edits: dict[int, list[Edit]] = field(default_factory=dict)
    exposed: array[int] = field(default_factory=lambda: array("q"))
    size: int = 0
    _times: list[int] = field(default_factory=list)
    _moments: dict[int, Moment] = field(default_factory=dict)

    def keep(self, chip: Chip) -> None:
        """Take a snapshot of the chip."""
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
        self.size += size
        while self.size > BUDGET and len(self._times) > 2:
            self._thin(time)

    def _thin(self, now: int) -> None:
        """Forget every other snapshot but the first and those near `now`.

        Each time, older ones get sparser.
        """
        near = bisect_left(self._times, now)
        newest = range(max(1, near - _NEWEST), near + 2) if len(self._times) > 2 * _NEWEST else ()
        for index, time in reversed(list(enumerate(self._times))):
            if index % 2 and index not in newest and time != now:
                self.size -= self._moments.pop(time).size
                del self._times[index]

    def before(self, time: int) -> Moment:
        """Return the last snapshot at or before a time. The first one always exists."""
        return self._moments[self._times[bisect_right(self._times, time) - 1]]

    def moments(self, until: int) -> list[Moment]:
        """Return the snapshots before a time, the newest first."""
        times = self._times[: bisect_left(self._times, until)]
        return [self._moments[time] for time in reversed(times)]

    def due(self, time: int, spacing: int = SPACING) -> int:
        """Return the time at which the next snapshot after `time` is due."""
        return self.before(time).time + spacing

    def frame_at(self, time: int) -> int:
        """Return the number of frames exposed before a time."""
        return bisect_right(self.exposed, time)

    def note_exposed(self, frame: int, time: int) -> None:
        """Record that a frame was exposed just before `time`."""
        if frame == len(self.exposed):
            self.exposed.append(time)

    def edit(self, time: int, edit: Edit) -> int:
        """Record an edit at a time, and forget what came after.

        The snapshot of that time is forgotten too; `keep` the edited state then.

        Returns:
            the number of later edits that are forgotten.
        """
        later = [at for at in self.edits if at > time]
        forgotten = sum(len(self.edits.pop(at)) for at in later)
        self.edits.setdefault(time, []).append(edit)
        keep = bisect_left(self._times, time)
        for at in self._times[keep:]:
            self.size -= self._moments.pop(at).size
        del self._times[keep:]
        del self.exposed[self.frame_at(time) :]
        return forgotten

    def __len__(self) -> int:
        return len(self._times)
