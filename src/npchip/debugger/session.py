"""A debugger without a screen: steps forward and back, breakpoints, edits, last writes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from npchip import Machine, Program
from npchip.base.errors import InputError
from npchip.debugger.clip import Recorded
from npchip.debugger.conditions import Condition, Stop, Watch
from npchip.debugger.history import Edit
from npchip.debugger.language import parse_condition
from npchip.debugger.names import Names
from npchip.debugger.runner import INTERRUPTED, Runner
from npchip.debugger.search import Search, Written
from npchip.debugger.values import Cell, Location, Pixel
from npchip.frames.feed import Frames, frame_source
from npchip.frames.memory import Memory
from npchip.isa import Isa
from npchip.program.graph import word_at
from npchip.program.model import SourceLine
from npchip.run.chip import Chip
from npchip.run.result import FrameRecord, Value

MAX_CYCLES: Final = 1_000_000
"""Default limit for the cycles of a frame, low enough to end an endless loop soon."""
_START: Final = Stop("start", "at the beginning")


@dataclass
class Breakpoint:
    """A condition with a number; `error` says why its text makes no sense in this program."""

    number: int
    text: str
    condition: Condition | None
    enabled: bool = True
    error: str | None = None


class Debugger:
    """A program on a chip, at one moment of its run.

    Args:
        program: the program to debug.
        frames: as for `Chip.feed`. Frames that can be read only once are kept in a temporary
            file.
        machine: as for `Chip`.
        isa: instruction set of the program; by default the built-in one.
        memory: as for `Chip`.
        max_cycles: limit for the cycles of one frame.

    Attributes:
        chip: the chip, to be read; only `edit` may change it.
        names: the names that conditions may use.
        breakpoints: breakpoints by number.
        stop: the reason of the last stop.
        edits: edits made so far, those that are forgotten too.

    Raises:
        InputError: as `Chip` and `Chip.feed`.
    """

    def __init__(
        self,
        program: Program,
        frames: Frames | None = None,
        machine: str | Path | Machine = "default",
        isa: Isa | None = None,
        *,
        memory: Memory = (),
        max_cycles: int = MAX_CYCLES,
    ) -> None:
        self.chip = Chip(program, machine, isa=isa, memory=memory)
        self.program = program
        self.names = Names(program, self.chip.machine, self.chip.isa)
        self.breakpoints: dict[int, Breakpoint] = {}
        self.stop = _START
        self.edits = 0
        clip = None if frames is None else Recorded(frame_source(frames, self.chip.machine))
        self.chip.feed(clip)
        self._runner = Runner(self.chip, clip, self.names.writers, max_cycles)
        self._search = Search(self._runner, self.names.writers)
        self._numbers = 0

    # ---- the present moment

    @property
    def time(self) -> int:
        """Instructions executed since reset."""
        return self.chip.instructions

    @property
    def line(self) -> SourceLine | None:
        """Source line of the next instruction."""
        return self.program.place(self.chip.pc)

    @property
    def at_call(self) -> bool:
        """True if the next instruction is a call."""
        word = word_at(self.program.decoded(self.chip.isa), self.chip.pc)
        return word is not None and "call" in word.form.effects

    @property
    def outputs(self) -> dict[str, Value]:
        """Outputs of this frame so far; None for those that cannot be read yet."""
        return self._runner.outputs()

    @property
    def records(self) -> dict[int, FrameRecord]:
        """Outputs and cycles of the last complete frames, by number; -1 is the set-up."""
        taken = self.chip.frames_taken
        ended = self.stop.reason in {"halted", "frames-exhausted"}
        return {
            frame: record
            for frame, record in self._runner.records.items()
            if frame < taken - 1 or (ended and frame == taken - 1)
        }

    @property
    def snapshots(self) -> tuple[int, int]:
        """Number of snapshots and the bytes that they take."""
        return len(self._runner.history), self._runner.history.size

    def tell_frames(self, told: Callable[[int, FrameRecord], None]) -> None:
        """Call a function, in the thread that moves, with each frame that is complete.

        A frame that is executed again is told again. The set-up has the number -1.
        """
        self._runner.on_frame = told

    def interrupt(self) -> None:
        """Stop a movement that runs in another thread."""
        self._runner.interrupted.set()

    # ---- what stops a run

    def add(self, text: str) -> Breakpoint:
        """Add a breakpoint or watchpoint.

        Raises:
            CommandError: the text makes no sense in this program.
        """
        return self.add_condition(parse_condition(text, self.names))

    def add_condition(self, condition: Condition, *, enabled: bool = True) -> Breakpoint:
        """Add a breakpoint or watchpoint that has been parsed."""
        return self._add(condition.text, condition, enabled=enabled)

    def add_broken(self, text: str, error: str) -> Breakpoint:
        """Add a text that makes no sense in this program, disabled."""
        return self._add(text, None, enabled=False, error=error)

    def _add(self, text: str, condition: Condition | None, **state: Any) -> Breakpoint:
        self._numbers += 1
        added = Breakpoint(self._numbers, text, condition, **state)
        self.breakpoints[added.number] = added
        return added

    # ---- forward

    def step(self, count: int = 1) -> Stop:
        """Execute `count` instructions, or up to a breakpoint."""
        return self._forward("stepped", time=self.time + count)

    def step_over(self) -> Stop:
        """Execute one instruction, or a call and its routine, or up to a breakpoint."""
        chip = self.chip
        if not self.at_call:
            return self.step()
        depth = len(chip.stack)
        return self._forward("stepped over the call", goal=lambda: len(chip.stack) <= depth)

    def step_out(self) -> Stop:
        """Execute the rest of the routine, or up to a breakpoint."""
        chip = self.chip
        depth = len(chip.stack)
        if not depth:
            return self._stopped(Stop("step", "no call is open"))
        return self._forward("returned", goal=lambda: len(chip.stack) < depth)

    def run(self) -> Stop:
        """Run to a breakpoint or the end."""
        return self._forward("")

    def run_to(self, condition: Condition) -> Stop:
        """Run to a condition, or a breakpoint before it."""
        return self._forward(f"reached {condition.text}", also=condition)

    def next_frame(self, count: int = 1) -> Stop:
        """Run to just after the expose of a later frame, or a breakpoint before it."""
        frame = self.chip.frames_taken + count
        return self._forward(f"frame {frame - 1} is exposed", frame=frame)

    def _forward(
        self,
        message: str,
        *,
        time: int | None = None,
        frame: int | None = None,
        goal: Callable[[], bool] | None = None,
        also: Condition | None = None,
    ) -> Stop:
        self._runner.interrupted.clear()
        conditions = self._enabled() + ([] if also is None else [(0, also)])
        watch = Watch(self.chip, conditions)
        stop, found = self._runner.forward(watch, time=time, frame=frame, goal=goal)
        if stop.reason == "breakpoint":
            stop = self._hit(found, message)
        elif not stop.message:
            stop = Stop(stop.reason, message)
        return self._stopped(stop)

    def _enabled(self) -> list[tuple[int, Condition]]:
        return [
            (number, item.condition)
            for number, item in self.breakpoints.items()
            if item.enabled and item.condition is not None
        ]

    def _hit(self, found: list[int], message: str = "") -> Stop:
        numbers = tuple(number for number in found if number)
        if not numbers:
            return Stop("place", message)
        texts = [f"{number} ({self.breakpoints[number].text})" for number in numbers]
        return Stop("breakpoint", f"breakpoint {', '.join(texts)}", numbers)

    def _stopped(self, stop: Stop) -> Stop:
        self.stop = stop
        return stop

    # ---- backward

    def restart(self) -> Stop:
        """Go to the beginning and forget the edits."""
        self._runner.restart()
        return self._stopped(_START)

    def seek(self, time: int) -> Stop:
        """Go to the moment after `time` instructions, without a stop at breakpoints."""
        self._runner.interrupted.clear()
        there = Stop("step", f"at instruction {time}")
        if time <= self.time:
            return self._back(max(0, time), there)
        nothing = Watch(self.chip)
        stop = Stop("outputs", "")
        while stop.reason == "outputs":  # a frame whose outputs cannot be read stops only once
            stop, _ = self._runner.forward(nothing, time=time)
        return self._stopped(stop if stop.message else there)

    def step_back(self, count: int = 1) -> Stop:
        """Undo `count` instructions."""
        self._runner.interrupted.clear()
        return self._back(max(0, self.time - count), Stop("step", "stepped back"))

    def previous_frame(self, count: int = 1) -> Stop:
        """Go back to just after the expose of this frame, or of an earlier one."""
        self._runner.interrupted.clear()
        exposed = self._runner.history.exposed
        taken = self.chip.frames_taken
        taken -= bool(taken and exposed[taken - 1] == self.time) + count - 1
        if taken < 1:
            return self._back(0, Stop("step", ""))
        return self._back(exposed[taken - 1], Stop("frame", f"frame {taken - 1} is exposed"))

    def run_back(self) -> Stop:
        """Go back to the last moment at which a breakpoint would have stopped."""
        self._runner.interrupted.clear()
        conditions = self._enabled()
        if self.time and conditions:
            here = self.chip.snapshot()
            found = self._search.last_hit(Watch(self.chip, conditions))
            self.chip.restore(here)
            if self._runner.interrupted.is_set():
                return self._stopped(INTERRUPTED)
            if found is not None:
                return self._back(found[0], self._hit(found[1]))
        return self._back(0, Stop("step", ""))

    def _back(self, time: int, stop: Stop) -> Stop:
        self._runner.seek(time)
        if self._runner.interrupted.is_set():
            return self._stopped(INTERRUPTED)
        if not self.time and stop.reason != "breakpoint":
            stop = _START
        return self._stopped(stop)

    # ---- edits and last writes

    def edit(self, target: Cell | Location, value: int) -> int:
        """Set a value, and forget what came after this moment.

        Returns:
            the number of later edits that are forgotten.

        Raises:
            InputError: NP352, a value out of range; no frame for a pixel; the activity.
        """
        chip = self.chip
        kind = getattr(getattr(target, "cell", target), "kind", None)
        most = 1 if kind == "flag" else 255
        if not 0 <= value <= most:
            raise InputError("NP352", f"{target}: expected 0 to {most}, found {value}")
        if isinstance(target, Pixel) and chip.frame is None:
            raise InputError("NP352", f"{target}: no frame has been exposed yet")
        if kind == "active":
            raise InputError("NP352", "the activity follows from the masks and cannot be set")
        old = target.plane(chip).copy() if isinstance(target, Cell) else target.value(chip)
        made = Edit(target, value, np.asarray(old))
        forgotten = self._runner.history.edit(self.time, made)
        made.apply(chip)
        self.edits += 1
        self._runner.history.keep(chip)
        return forgotten

    def who(self, location: Location) -> Written | None:
        """Return the last write of a location up to this moment; None if interrupted."""
        self._runner.interrupted.clear()
        here = self.chip.snapshot()
        try:
            return self._search.last_write(location)
        finally:
            self.chip.restore(here)
