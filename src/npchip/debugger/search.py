"""Searches in the past: the last stop of a watch, the last write of a location."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from npchip.debugger.conditions import Watch
from npchip.debugger.history import Moment
from npchip.debugger.runner import Runner
from npchip.debugger.values import Location, Writers, wrote
from npchip.program.model import SourceLine


class Written(NamedTuple):
    """The last write of a location.

    Attributes:
        by: an instruction, an edit, or nobody since reset.
        old: the value before.
        new: the value after.
        cycle: cycles since reset before the instruction, or at the edit.
        frame: number of the frame, -1 before the first.
        time: instructions executed, this one included.
        address: address of the instruction; None for an edit.
        line: its source line.
    """

    by: Literal["instruction", "edit", "nobody"]
    old: int
    new: int
    cycle: int = 0
    frame: int = -1
    time: int = 0
    address: int | None = None
    line: SourceLine | None = None


class Search:
    """Searches from snapshot to snapshot, the newest first; replays only relevant intervals.

    Args:
        runner: the runner of the session, now at the end of the past to search.
        writers: the writers of its program.
    """

    def __init__(self, runner: Runner, writers: Writers) -> None:
        self._runner = runner
        self._writers = writers

    def last_hit(self, watch: Watch) -> tuple[int, list[int]] | None:
        """Return the last earlier moment at which a watch stops, and the numbers it finds there.

        The chip is then at another moment.
        """
        runner, chip = self._runner, self._runner.chip

        def matters(moment: Moment, later: Moment) -> bool:
            return watch.stops_at(later.pc) or watch.touched(later.executions - moment.executions)

        for _, end in runner.intervals(chip.instructions - 1, matters):
            hit = None
            watch.begin()
            for address, _ in runner.replay(end, self._writers.all, lambda: chip.pc):
                numbers = watch.after(address)
                if numbers:
                    hit = chip.instructions, numbers
                if chip.instructions in runner.history.edits:
                    watch.begin()
            if hit is not None or runner.interrupted.is_set():
                return hit
        return None

    def last_write(self, location: Location) -> Written | None:
        """Return the last write of a location up to this moment; None if interrupted.

        The chip is then at another moment.
        """
        runner, chip = self._runner, self._runner.chip
        candidates = self._writers.of(location)
        addresses = np.array(sorted(candidates), np.intp)
        now, value = chip.instructions, location.value(chip)
        edits = runner.history.edits
        edited = max(
            (at for at in edits if at <= now and any(e.reaches(location) for e in edits[at])),
            default=-1,
        )

        def matters(moment: Moment, later: Moment) -> bool:
            executed = later.executions[addresses] - moment.executions[addresses]
            return bool(executed.any()) or moment.time < edited

        for moment, end in runner.intervals(now, matters):
            found = self._write_before(location, end, candidates)
            if runner.interrupted.is_set():
                return None
            if found is not None and found.time > edited:
                return found
            if moment.time < edited:
                break
        if edited < 0:
            return Written("nobody", value, value)
        runner.seek(edited)
        edit = next(e for e in reversed(edits[edited]) if e.reaches(location))
        frame, old = chip.frames_taken - 1, edit.old_of(location)
        return Written("edit", old, edit.value, chip.cycles, frame, edited)

    def _write_before(
        self, location: Location, end: int, candidates: frozenset[int]
    ) -> Written | None:
        chip, last = self._runner.chip, None

        def before() -> tuple[int, int, int]:
            return chip.pc, chip.cycles, location.value(chip)

        for (address, cycle, old), writes in self._runner.replay(end, candidates, before):
            if any(wrote(write, location) for write in writes):
                last = Written(
                    "instruction",
                    old,
                    self._value_before_edits(location),
                    cycle,
                    chip.frames_taken - 1,
                    chip.instructions,
                    address,
                    chip.program.place(address),
                )
        return last

    def _value_before_edits(self, location: Location) -> int:
        chip = self._runner.chip
        for edit in self._runner.history.edits.get(chip.instructions, ()):
            if edit.reaches(location):
                return edit.old_of(location)
        return location.value(chip)
