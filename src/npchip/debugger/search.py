"""Looking for what happened before: the last stop of a watch, the last write of a place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from npchip.debugger.values import Place, Writers, wrote

if TYPE_CHECKING:
    from npchip.debugger.conditions import Watch
    from npchip.debugger.history import Moment
    from npchip.debugger.runner import Runner
    from npchip.program.model import SourceLine


@dataclass(frozen=True)
class Written:
    """The last write of a place.

    Attributes:
        place: the place.
        by: an instruction, an edit, or nobody since reset.
        address: of the instruction; None for an edit.
        line: its source line.
        cycle: cycles since reset before the instruction, or at the edit.
        frame: number of the frame, -1 before the first.
        time: instructions executed, this one included.
        old: the value before.
        new: the value after.
    """

    place: Place
    by: Literal["instruction", "edit", "nobody"]
    address: int | None
    line: SourceLine | None
    cycle: int
    frame: int
    time: int
    old: int
    new: int


class Search:
    """Goes from snapshot to snapshot, the newest first, and again through what may matter.

    Args:
        runner: what has come to this moment.
        writers: of its program.
    """

    def __init__(self, runner: Runner, writers: Writers) -> None:
        self._runner = runner
        self._writers = writers

    def last_hit(self, watch: Watch) -> tuple[int, list[int]] | None:
        """Return the last moment before this one at which a watch stops, and what it finds.

        The chip is then somewhere else.
        """
        runner, chip = self._runner, self._runner.chip

        def matters(moment: Moment, later: Moment) -> bool:
            return watch.stops_at(later.pc) or watch.touched(later.executions - moment.executions)

        for moment, end in runner.intervals(chip.instructions - 1, matters):
            hit = None
            address: int | None = None
            for _ in runner.replay(moment, end, self._writers.all):
                if address is None:
                    if chip.instructions == moment.time:
                        watch.begin()
                    address = chip.pc
                    continue
                numbers = watch.after(address)
                if numbers:
                    hit = chip.instructions, numbers
                if chip.instructions in runner.history.edits:
                    watch.begin()
                address = None
            if hit is not None or runner.interrupted.is_set():
                return hit
        return None

    def last_write(self, place: Place) -> Written | None:
        """Return the last write of a place, at or before this moment; None if interrupted.

        The chip is then somewhere else.
        """
        runner, chip = self._runner, self._runner.chip
        candidates = self._writers.of(place)
        addresses = np.array(sorted(candidates), np.intp)
        now, value = chip.instructions, place.value(chip)
        edits = runner.history.edits
        edited = max(
            (at for at in edits if at <= now and any(e.reaches(place) for e in edits[at])),
            default=-1,
        )

        def matters(moment: Moment, later: Moment) -> bool:
            executed = later.executions[addresses] - moment.executions[addresses]
            return bool(executed.any()) or moment.time < edited

        for moment, end in runner.intervals(now, matters):
            found = self._writes(place, moment, end, candidates)
            if runner.interrupted.is_set():
                return None
            if found is not None and found.time > edited:
                return found
            if moment.time < edited:
                break
        if edited >= 0:
            return self._edited(place, edited)
        return Written(place, "nobody", None, None, 0, -1, 0, value, value)

    def _writes(
        self, place: Place, moment: Moment, end: int, candidates: frozenset[int]
    ) -> Written | None:
        """The last write between a snapshot and a time."""
        chip = self._runner.chip
        last: Written | None = None
        before: tuple[int, int, int] | None = None
        for written in self._runner.replay(moment, end, candidates):
            if before is None:
                before = chip.pc, chip.cycles, place.value(chip)
                continue
            address, cycle, old = before
            before = None
            if any(wrote(write, place) for write in written):
                last = Written(
                    place=place,
                    by="instruction",
                    address=address,
                    line=chip.program.place(address),
                    cycle=cycle,
                    frame=chip.frames_taken - 1,
                    time=chip.instructions,
                    old=old,
                    new=self._value_before_edits(place),
                )
        return last

    def _value_before_edits(self, place: Place) -> int:
        chip = self._runner.chip
        for edit in self._runner.history.edits.get(chip.instructions, ()):
            if edit.reaches(place):
                return edit.old_of(place)
        return place.value(chip)

    def _edited(self, place: Place, time: int) -> Written:
        self._runner.seek(time)
        edit = next(e for e in reversed(self._runner.history.edits[time]) if e.reaches(place))
        chip = self._runner.chip
        frame, old = chip.frames_taken - 1, edit.old_of(place)
        return Written(place, "edit", None, None, chip.cycles, frame, time, old, edit.value)
